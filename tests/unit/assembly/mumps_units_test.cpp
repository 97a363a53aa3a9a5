// Solutions whatever units stiffnesses and couplings are in.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "dense.hpp"
#include "lacon/assembly/mumps_engine.hpp"
#include "saddle_point.hpp"

namespace lacon {
namespace {

using test::Chain;
using test::dense;
using test::entries;
using test::SaddlePoint;
constexpr MumpsOptions::Use always_used = MumpsOptions::Use::always;

// Single precision carries forces and lengths far outside its own range.
TEST(MumpsUnits, MayBeFarOutsideTheRangeOfSinglePrecision) {
  SaddlePoint system;
  std::vector<double> values(system.matrix.values().begin(), system.matrix.values().end());
  for (double& value : values) value *= 1e60;
  for (std::int64_t row = system.chain.numbering.of_patch(0); row < system.matrix.size(); ++row)
    for (std::int64_t k = system.matrix.rows()[row]; k < system.matrix.rows()[row + 1]; ++k) values[k] *= 1e-90;
  system.matrix.restore(values);
  MumpsEngine engine({.single_precision = always_used});
  engine.analyse(system.matrix);
  EXPECT_EQ(engine.factorise(system.matrix).doubt, "");
  Eigen::VectorXd b = 1e60 * Eigen::VectorXd::Random(system.matrix.size()), x = b;
  for (std::int64_t row = system.chain.numbering.of_patch(0); row < system.matrix.size(); ++row) b[row] = x[row] = 1e-30;
  EXPECT_LE(engine.solve(entries(x)).residual, 1e-15);
  const Eigen::VectorXd left = dense(system.matrix) * x - b;
  EXPECT_LE(left.head(58).cwiseAbs().maxCoeff(), 1e-13 * b.head(58).cwiseAbs().maxCoeff());
  EXPECT_LE(left.tail(2).cwiseAbs().maxCoeff(), 1e-13 * 1e-30);
}

// Couplings may be far larger than stiffnesses (areas in square nanometres beside N/nm): these are no zeros beside
// them.
TEST(MumpsUnits, MayMakeCouplingsFarLargerThanStiffnesses) {
  for (const auto& [single, least] :
       {std::pair(false, 0.5), std::pair(true, 0.5), std::pair(false, 1e-18), std::pair(true, 1e-18)}) {
    SCOPED_TRACE(fmt::format("{}, least coupling {}", single ? "in single precision" : "exact", least));
    SaddlePoint system;
    std::vector<double> values(system.matrix.values().begin(), system.matrix.values().end());
    for (double& value : values)
      if (value == -0.5) value = -least;
    system.matrix.restore(values);
    const Eigen::VectorXd b = Eigen::VectorXd::Random(system.matrix.size());
    Eigen::VectorXd expected = dense(system.matrix).fullPivLu().solve(b), x = b;
    constexpr double factor = 0x1p60;
    for (std::int64_t row = system.chain.numbering.of_patch(0); row < system.matrix.size(); ++row) {
      for (std::int64_t k = system.matrix.rows()[row]; k < system.matrix.rows()[row + 1]; ++k) values[k] *= factor;
      x[row] *= factor;
      expected[row] /= factor;
    }
    system.matrix.restore(values);
    MumpsEngine engine({.single_precision = single ? always_used : MumpsOptions{}.single_precision});
    engine.analyse(system.matrix);
    const Factorisation found = engine.factorise(system.matrix);
    EXPECT_TRUE(found.null_pivots.empty());
    EXPECT_EQ(found.negative_pivots, 2);
    EXPECT_EQ(found.single_precision, single);
    std::vector<float> column =
        engine.substitute(std::vector<std::int64_t>{0, 1}, std::vector<std::int32_t>{7}, std::vector<double>{1});
    EXPECT_LE(engine.solve(entries(x)).residual, 1e-15);
    for (const auto& part : {Eigen::seq(0, 57), Eigen::seq(58, 59)})
      EXPECT_LE((x - expected)(part).cwiseAbs().maxCoeff(), 1e-11 * expected(part).cwiseAbs().maxCoeff());
    Eigen::VectorXd unit = Eigen::VectorXd::Unit(system.matrix.size(), 7);
    engine.solve(entries(unit));
    for (int i = 0; i < unit.size(); ++i)
      EXPECT_NEAR(column[i], unit[i], 1e-5 * (i < 58 ? unit.head(58) : unit.tail(2)).cwiseAbs().maxCoeff());
  }
}

// One stiffness that is next to nothing makes no zeros of multipliers that meet others: a reference node on a weak spring, to
// which many nodes of a body are tied.
TEST(MumpsUnits, AreNotToldByOneWeakSpring) {
  constexpr std::int32_t n = 30, ties = 3, reference = n - 1;
  const Chain chain(n, ties, SaddlePoint::held());
  std::vector<Coupling> couplings;
  for (std::int32_t p = 0; p < ties; ++p)
    for (const std::int32_t node : {reference, 5 + 9 * p}) couplings.push_back({n + p, node});
  for (const bool single : {false, true})
    for (const double weak : {1e-3, 1e-6, 1e-14}) {
      SCOPED_TRACE(fmt::format("{} {}", single ? "in single precision" : "exact", weak));
      SparseMatrix matrix(chain.numbering, chain.cliques, couplings);
      for (int d = 0; d < 2; ++d) {
        for (std::int32_t i = 0; i + 1 < reference; ++i)
          matrix.add(std::vector<std::int64_t>{chain.numbering.of(i, d), chain.numbering.of(i + 1, d)},
                     std::vector<double>{1e10, -1e10, 1e10});
        matrix.add_diagonal(chain.numbering.of(reference, d), weak);
      }
      for (const Coupling& c : couplings)
        matrix.add(std::vector<std::int64_t>{chain.numbering.of_patch(c.a - n), chain.numbering.of(c.b, 0)},
                   std::vector<double>{0, c.b == reference ? -1.0 : 1.0, 0});
      MumpsEngine engine({.single_precision = single ? always_used : MumpsOptions{}.single_precision});
      engine.analyse(matrix);
      const Factorisation found = engine.factorise(matrix);
      EXPECT_TRUE(found.null_pivots.empty());
      EXPECT_EQ(found.negative_pivots, ties);
    }
}

}  // namespace
}  // namespace lacon
