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
constexpr MumpsOptions::Use always = MumpsOptions::Use::always;

// Single precision carries forces and lengths far outside its own range.
TEST(MumpsUnits, MayBeFarOutsideTheRangeOfSinglePrecision) {
  SaddlePoint system;
  std::vector<double> values(system.matrix.values().begin(), system.matrix.values().end());
  for (double& value : values) value *= 1e60;
  for (std::int64_t row = system.chain.numbering.of_patch(0); row < system.matrix.size(); ++row)
    for (std::int64_t k = system.matrix.rows()[row]; k < system.matrix.rows()[row + 1]; ++k) values[k] *= 1e-90;
  system.matrix.restore(values);
  MumpsEngine engine({.single_precision = always});
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
    MumpsEngine engine({.single_precision = single ? always : MumpsOptions{}.single_precision});
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

// One stiffness that is next to nothing makes no zero of a multiplier that meets others: a reference node on a weak spring,
// tied to a body.
TEST(MumpsUnits, AreNotToldByOneWeakSpring) {
  for (const bool single : {false, true})
    for (const double weak : {1e-3, 1e-6, 1e-14}) {
      SCOPED_TRACE(fmt::format("{} {}", single ? "single" : "exact", weak));
      const Chain chain(30, 2, SaddlePoint::held());
      // the last node hangs on a spring to the ground, and on two multipliers that tie it to others
      std::vector<Coupling> couplings;
      for (std::int32_t p = 0; p < 2; ++p)
        for (const std::int32_t node : {29, 5 + 9 * p}) couplings.push_back({30 + p, node});
      Ragged<std::int32_t> cliques;
      for (std::int32_t i = 0; i + 2 < 30; ++i) cliques.push_back(std::vector<std::int32_t>{i, i + 1});
      SparseMatrix matrix(chain.numbering, cliques, couplings);
      for (std::int32_t i = 0; i + 2 < 30; ++i)
        for (int d = 0; d < 2; ++d)
          matrix.add(std::vector<std::int64_t>{chain.numbering.of(i, d), chain.numbering.of(i + 1, d)},
                     std::vector<double>{1e10, -1e10, 1e10});
      for (int d = 0; d < 2; ++d) matrix.add_diagonal(chain.numbering.of(29, d), weak);
      for (std::int32_t p = 0; p < 2; ++p)
        for (const auto& [node, value] : {std::pair(29, -1.0), std::pair(5 + 9 * p, 1.0)})
          matrix.add(std::vector<std::int64_t>{chain.numbering.of_patch(p), chain.numbering.of(node, p)},
                     std::vector<double>{0, value, 0});
      MumpsEngine engine({.single_precision = single ? always : MumpsOptions{}.single_precision});
      engine.analyse(matrix);
      const Factorisation found = engine.factorise(matrix);
      EXPECT_TRUE(found.null_pivots.empty());
      EXPECT_EQ(found.doubt, "");
      EXPECT_EQ(found.negative_pivots, 2);
    }
}

}  // namespace
}  // namespace lacon
