#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "dense.hpp"
#include "lacon/assembly/dependent_rows.hpp"
#include "lacon/assembly/ordering.hpp"
#include "lattice.hpp"

namespace lacon {
namespace {

using test::Chain;
using test::dense;

// Imposed displacements have no equation; the others are numbered node by node, multipliers last.
TEST(Numbering, LeavesOutWhatIsImposed) {
  const Chain chain(3, 2, {1, 0, 0, 0, 1, 1});
  EXPECT_EQ(chain.numbering.n_equations(), 5);
  EXPECT_EQ(chain.numbering.of(0, 0), 0);
  EXPECT_EQ(chain.numbering.of(0, 1), -1);
  EXPECT_EQ(chain.numbering.of(1, 0), -1);
  EXPECT_EQ(chain.numbering.of(2, 1), 2);
  EXPECT_EQ(chain.numbering.of_patch(1), 4);
}

// The sum of element matrices is what dense addition gives, with equations left out and in any order.
TEST(SparseMatrix, AssemblesAsDenseAdditionDoes) {
  std::mt19937 random(7);
  const Chain chain(6, 0, {1, 1, 0, 1, 1, 1, 1, 0, 1, 1, 1, 1});
  SparseMatrix matrix(chain.numbering, chain.cliques, {});
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(matrix.size(), matrix.size());
  for (std::size_t c = 0; c < chain.cliques.size(); ++c) {
    std::vector<std::int64_t> equations;
    for (const int k : {1, 0})
      for (int d = 0; d < 2; ++d) equations.push_back(chain.numbering.of(chain.cliques[c][k], d));
    const std::vector<double> lower = test::random_lower(4, random);
    matrix.add(equations, lower);
    for (int i = 0, at = 0; i < 4; ++i)
      for (int j = 0; j <= i; ++j, ++at) {
        if (equations[i] < 0 || equations[j] < 0) continue;
        expected(equations[i], equations[j]) += lower[at];
        if (i != j) expected(equations[j], equations[i]) += lower[at];
      }
  }
  EXPECT_EQ((dense(matrix) - expected).cwiseAbs().maxCoeff(), 0.0);
}

// A copy and what it was copied from have the same values in one place, until one of the two changes: the other one stays.
TEST(SparseMatrix, IsCopiedWhereItChanges) {
  const Chain chain(4, 1);
  SparseMatrix matrix(chain.numbering, chain.cliques, {});
  matrix.add_diagonal(1, 2.0);
  SparseMatrix copy = matrix;
  EXPECT_EQ(copy.values().data(), matrix.values().data());
  EXPECT_EQ(copy.columns().data(), matrix.columns().data());
  const std::vector<double> before(matrix.values().begin(), matrix.values().end()), row(matrix.row_values(2).size(), 5.0);
  const auto is_as_before = [&](const SparseMatrix& one) { return std::ranges::equal(one.values(), before); };
  copy.add_diagonal(1, 3.0);
  EXPECT_EQ(copy.diagonal(1), 5.0);
  EXPECT_TRUE(is_as_before(matrix));
  copy = matrix;
  copy.set_row(2, row);
  EXPECT_TRUE(std::ranges::equal(copy.row_values(2), row));
  EXPECT_TRUE(is_as_before(matrix));
  copy = matrix;
  matrix.set_zero();
  EXPECT_TRUE(is_as_before(copy));
  matrix.restore(before);
  matrix.add(std::vector<std::int64_t>{0, 1}, std::vector<double>{1.0, 2.0, 3.0});
  EXPECT_TRUE(is_as_before(copy));
  matrix.copy_rows(copy, matrix.size());
  EXPECT_TRUE(is_as_before(matrix));
  EXPECT_NE(copy.values().data(), matrix.values().data());
}

// Two degrees of freedom with one equation (tied multipliers): R^T A R with the identification R.
TEST(SparseMatrix, AddsUpTiedDegreesOfFreedom) {
  std::mt19937 random(3);
  const Chain chain(2, 1);
  const std::vector<Coupling> couplings{{2, 0}, {2, 1}};
  SparseMatrix matrix(chain.numbering, chain.cliques, couplings);
  const std::vector<std::int64_t> equations{0, 4, 1, 4};
  const std::vector<double> lower = test::random_lower(4, random);
  matrix.add(equations, lower);
  Eigen::MatrixXd element = Eigen::MatrixXd::Zero(4, 4), identification = Eigen::MatrixXd::Zero(4, 5);
  for (int i = 0, at = 0; i < 4; ++i)
    for (int j = 0; j <= i; ++j, ++at) element(i, j) = element(j, i) = lower[at];
  for (int i = 0; i < 4; ++i) identification(i, equations[i]) = 1;
  const Eigen::MatrixXd expected = identification.transpose() * element * identification;
  EXPECT_LE((dense(matrix) - expected).cwiseAbs().maxCoeff(), 4e-16);
}

TEST(SparseMatrix, MultipliesBySymmetry) {
  std::mt19937 random(5);
  const Chain chain(5);
  SparseMatrix matrix(chain.numbering, chain.cliques, {});
  test::add_springs(matrix, chain);
  Eigen::VectorXd x = Eigen::VectorXd::Random(matrix.size()), y(matrix.size());
  matrix.multiply({x.data(), static_cast<std::size_t>(x.size())}, {y.data(), static_cast<std::size_t>(y.size())});
  EXPECT_LE((y - dense(matrix) * x).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_NEAR(matrix.norm(), dense(matrix).cwiseAbs().rowwise().sum().maxCoeff(), 1e-14);
}

// What is gathered in parts of a large matrix is what its entries give one by one, and has the same bits for any number of
// threads.
TEST(SparseMatrix, IsTheSameInParts) {
  const test::Lattice lattice(36, 1e3);  // 45 360 equations
  const SparseMatrix& matrix = lattice.matrix;
  const auto n = static_cast<std::size_t>(matrix.size());
  std::mt19937 random(6);
  const std::vector<double> x = test::random_values(2 * n, random);
  std::vector<double> product(n, 0.0), magnitudes(n, 0.0), sums(n, 0.0), first(n), second(n);
  for (std::size_t i = 0; i < n; ++i) first[i] = x[2 * i], second[i] = x[2 * i + 1];
  const auto add = [&](std::size_t i, std::size_t j, double value) {
    product[i] += value * first[j];
    magnitudes[i] += std::abs(value) * std::abs(second[j]);
    sums[i] += std::abs(value);
  };
  for (std::size_t i = 0; i < n; ++i)
    for (std::int64_t k = matrix.rows()[i]; k < matrix.rows()[i + 1]; ++k) {
      const auto j = static_cast<std::size_t>(matrix.columns()[k]);
      add(i, j, matrix.values()[k]);
      if (i != j) add(j, i, matrix.values()[k]);
    }
  struct Found {
    std::vector<double> product, magnitudes, together, scale;
    double norm;
    bool operator==(const Found&) const = default;
  };
  const auto find = [&](const char* threads) {
    setenv("LACON_THREADS", threads, 1);
    Found found{std::vector<double>(n), std::vector<double>(n), std::vector<double>(2 * n), matrix.equilibration(),
                matrix.norm()};
    matrix.multiply(first, found.product);
    matrix.multiply_magnitudes(second, found.magnitudes);
    matrix.multiply_together(x, found.together, 2);
    return found;
  };
  const Found found = find("1");
  EXPECT_TRUE(found == find("2"));
  EXPECT_TRUE(found == find("5"));
  unsetenv("LACON_THREADS");
  const std::vector<SparseMatrix::RowSize> sizes = matrix.row_sizes(matrix.size());
  constexpr double round_off = 1e-15;  // of the sum of magnitudes of a row, 7 entries
  for (std::size_t i = 0; i < n; ++i) {
    ASSERT_NEAR(found.product[i], product[i], 7 * round_off * sums[i]);
    ASSERT_NEAR(found.magnitudes[i], magnitudes[i], 7 * round_off * sums[i]);
    ASSERT_EQ(found.together[2 * i], found.product[i]);
    ASSERT_EQ(found.together[2 * i + 1], found.magnitudes[i]);
    ASSERT_NEAR(sizes[i].sum, sums[i], 7 * round_off * sums[i]);
    ASSERT_LE(sizes[i].entries, 7);
  }
  EXPECT_NEAR(found.norm, *std::ranges::max_element(sums), 7 * round_off * found.norm);
}

// A pattern knows what fits into it: the analysis may stand exactly then.
TEST(SparseMatrix, KnowsItsRoom) {
  const Chain chain(4, 1);
  const std::vector<Coupling> couplings{{4, 0}};
  const SparseMatrix matrix(chain.numbering, chain.cliques, couplings);
  EXPECT_TRUE(matrix.has_room_for(couplings));
  EXPECT_TRUE(matrix.has_room_for(std::vector<Coupling>{{1, 2}, {0, 4}}));
  EXPECT_FALSE(matrix.has_room_for(std::vector<Coupling>{{4, 3}}));
}

// The same of unsymmetric element matrices, with symmetric ones among them, tied degrees of freedom and equations left out:
// R^T A R with the identification R.
TEST(SparseMatrix, AssemblesUnsymmetricMatrices) {
  std::mt19937 random(17);
  const Chain chain(5, 2, {1, 1, 0, 1, 1, 1, 1, 0, 1, 1});
  const std::vector<Coupling> couplings{{5, 0}, {5, 4}, {6, 5}, {4, 0}};
  SparseMatrix matrix(chain.numbering, chain.cliques, couplings, Symmetry::general);
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(matrix.size(), matrix.size());
  const auto add = [&](const std::vector<std::int64_t>& equations, bool symmetric) {
    const auto n = static_cast<Eigen::Index>(equations.size());
    const std::vector<double> values = symmetric ? test::random_lower(equations.size(), random)
                                                 : test::random_values(equations.size() * equations.size(), random);
    symmetric ? matrix.add(equations, values) : matrix.add_unsymmetric(equations, values);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j < n; ++j)
        if (equations[i] >= 0 && equations[j] >= 0)
          expected(equations[i], equations[j]) +=
              values[symmetric ? std::max(i, j) * (std::max(i, j) + 1) / 2 + std::min(i, j) : i * n + j];
  };
  const auto [patch, other] = std::pair(chain.numbering.of_patch(0), chain.numbering.of_patch(1));
  for (const bool symmetric : {false, true}) {
    add({chain.numbering.of(1, 1), chain.numbering.of(0, 0), chain.numbering.of(1, 0)}, symmetric);
    add({patch, chain.numbering.of(4, 0), patch, chain.numbering.of(0, 1)}, symmetric);
    add({patch, other}, symmetric);
  }
  matrix.add_diagonal(3, 0.5);
  expected(3, 3) += 0.5;
  EXPECT_LE((dense(matrix) - expected).cwiseAbs().maxCoeff(), 1e-15);
  for (std::int64_t e = 0; e < matrix.size(); ++e) EXPECT_EQ(matrix.diagonal(e), dense(matrix)(e, e));
  EXPECT_NEAR(matrix.norm(), dense(matrix).cwiseAbs().rowwise().sum().maxCoeff(), 1e-14);
  Eigen::VectorXd x = Eigen::VectorXd::Random(matrix.size()), y(matrix.size());
  matrix.multiply({x.data(), static_cast<std::size_t>(x.size())}, {y.data(), static_cast<std::size_t>(y.size())});
  EXPECT_LE((y - expected * x).cwiseAbs().maxCoeff(), 1e-14);
}

// Nodes and patches meet in the matrix wherever a coupling says so, in either order; what it grows by is zero at first, and the
// symmetric half has no more entries than the lower triangle.
TEST(SparseMatrix, GrowsByCouplesOfAnyVertices) {
  std::mt19937 random(19);
  const Chain chain(6, 3);
  const std::vector<Coupling> all{{6, 0}, {0, 5}, {8, 6}, {2, 7}, {5, 2}, {4, 4}};
  for (const Symmetry symmetry : {Symmetry::symmetric, Symmetry::general}) {
    SparseMatrix before(chain.numbering, chain.cliques, {}, symmetry);
    test::add_springs(before, chain);
    for (std::size_t count = 1; count <= all.size(); ++count) {
      const std::span<const Coupling> couplings(all.data(), count);
      const bool had_room = before.has_room_for(couplings);
      EXPECT_EQ(had_room, all[count - 1].a == all[count - 1].b);
      SparseMatrix matrix(chain.numbering, chain.cliques, couplings, symmetry);
      EXPECT_TRUE(matrix.has_room_for(couplings));
      EXPECT_EQ(matrix.n_entries() == before.n_entries(), had_room);
      matrix.copy_rows(before, matrix.size());
      EXPECT_EQ((dense(matrix) - dense(before)).cwiseAbs().maxCoeff(), 0.0);
      std::vector<std::int64_t> equations;
      for (const std::int32_t v : {all[count - 1].a, all[count - 1].b}) equations.push_back(chain.numbering.first[v]);
      EXPECT_NO_THROW(matrix.add(equations, test::random_lower(2, random)));
      before = matrix;
    }
    if (!before.is_symmetric()) continue;
    const SparseMatrix general(chain.numbering, chain.cliques, all, Symmetry::general);
    EXPECT_EQ(2 * before.n_entries(), general.n_entries() + before.size());
  }
}

// An element that does not fit is a defect of the caller, never a wrong entry.
TEST(SparseMatrix, RefusesWhatItHasNoRoomFor) {
  const Chain chain(4);
  SparseMatrix matrix(chain.numbering, chain.cliques, {});
  EXPECT_THROW(matrix.add(std::vector<std::int64_t>{0, 7}, std::vector<double>{1, 1, 1}), std::logic_error);
  EXPECT_THROW(matrix.add_unsymmetric(std::vector<std::int64_t>{0, 1}, std::vector<double>{1, 1, 1, 1}), std::logic_error);
  SparseMatrix smaller(chain.numbering, Ragged<std::int32_t>(), {});
  test::add_springs(matrix, chain);
  EXPECT_THROW(smaller.copy_rows(matrix, smaller.size()), std::logic_error);
}

// Every equation has one place, and a multiplier comes behind all nodes of its row.
TEST(Ordering, PutsMultipliersBehindTheirNodes) {
  const Chain chain(40, 3);
  std::vector<Coupling> couplings;
  for (std::int32_t p = 0; p < 3; ++p)
    for (std::int32_t k = 0; k < 5; ++k) couplings.push_back({40 + p, 12 * p + k});
  const SparseMatrix matrix(chain.numbering, chain.cliques, couplings);
  const std::vector<std::int32_t> order = elimination_order(matrix);
  std::vector<std::int32_t> sorted = order;
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t i = 0; i < sorted.size(); ++i) ASSERT_EQ(sorted[i], static_cast<std::int32_t>(i));
  for (const Coupling& c : couplings)
    for (int d = 0; d < 2; ++d) EXPECT_GT(order[chain.numbering.of_patch(c.a - 40)], order[chain.numbering.of(c.b, d)]);
}

// The sizes of rows are those of the dense matrix, of its leading block alone, stored in halves or whole.
TEST(SparseMatrix, KnowsHowLargeItsRowsAre) {
  const std::vector<Coupling> couplings{{4, 0}, {4, 2}, {0, 3}};
  for (const Symmetry symmetry : {Symmetry::symmetric, Symmetry::general}) {
    const Chain chain(4, 1);
    SparseMatrix matrix(chain.numbering, chain.cliques, couplings, symmetry);
    std::mt19937 random(4);
    for (std::size_t c = 0; c < chain.cliques.size(); ++c) {
      std::vector<std::int64_t> equations;
      for (const std::int32_t v : chain.cliques[c])
        for (std::int64_t e = chain.numbering.first[v]; e < chain.numbering.first[v + 1]; ++e) equations.push_back(e);
      matrix.add(equations, test::random_lower(equations.size(), random));
    }
    const std::int64_t n = chain.numbering.first[4];
    const Eigen::MatrixXd block = dense(matrix).topLeftCorner(n, n);
    const std::vector<SparseMatrix::RowSize> sizes = matrix.row_sizes(n);
    ASSERT_EQ(static_cast<std::int64_t>(sizes.size()), n);
    for (std::int64_t row = 0; row < n; ++row) {
      EXPECT_NEAR(sizes[row].sum, block.row(row).cwiseAbs().sum(), 1e-14);
      EXPECT_GE(sizes[row].entries, (block.row(row).array() != 0).count());
      EXPECT_LE(sizes[row].entries, n);
    }
  }
}

// A multiplier whose coefficients vanish is decided by its row, one of either symmetry; without a diagonal nothing decides it.
TEST(SparseMatrix, KnowsUnknownsThatTheirRowAloneDecides) {
  const Chain chain(12, 2);
  const std::vector<Coupling> couplings{{12, 3}, {12, 4}, {13, 9}};
  for (const Symmetry symmetry : {Symmetry::symmetric, Symmetry::general}) {
    SparseMatrix matrix(chain.numbering, chain.cliques, couplings, symmetry);
    test::add_springs(matrix, chain, 1.0);
    const std::int64_t held = chain.numbering.first[12], open = chain.numbering.first[13];
    matrix.add(std::vector<std::int64_t>{held, chain.numbering.first[3]}, std::vector<double>{0, 1, 0});
    EXPECT_EQ(matrix.rows_alone(), std::vector<std::int64_t>{});
    matrix.add_diagonal(open, -0.5);
    EXPECT_EQ(matrix.rows_alone(), std::vector<std::int64_t>{open});
    if (symmetry == Symmetry::general)  // others may see it
      matrix.add_unsymmetric(std::vector<std::int64_t>{open, chain.numbering.first[9]}, std::vector<double>{0, 0, 1, 0});
    EXPECT_EQ(matrix.rows_alone(), std::vector<std::int64_t>{open});
  }
}

// Products of magnitudes are those of dense matrices; powers of two bring the largest entry of each row near 1, whatever units
// rows are in.
TEST(SparseMatrix, IsEquilibratedByPowersOfTwo) {
  std::mt19937 random(5);
  const Chain chain(12, 2);
  const std::vector<Coupling> couplings{{12, 3}, {12, 4}, {13, 9}};
  for (const Symmetry symmetry : {Symmetry::symmetric, Symmetry::general}) {
    SparseMatrix matrix(chain.numbering, chain.cliques, couplings, symmetry);
    for (const Coupling& c : couplings)
      matrix.add(std::vector<std::int64_t>{chain.numbering.first[c.a], chain.numbering.first[c.b]},
                 std::vector<double>{0, 1e-25, 0});
    test::add_springs(matrix, chain, 1e30);
    const Eigen::MatrixXd full = dense(matrix);
    const Eigen::VectorXd x = Eigen::VectorXd::Random(full.rows());
    Eigen::VectorXd y(full.rows());
    matrix.multiply_magnitudes({x.data(), 26}, {y.data(), 26});
    EXPECT_LE((full.cwiseAbs() * x.cwiseAbs() - y).cwiseAbs().maxCoeff(), 1e-15 * y.maxCoeff());
    const std::vector<double> scale = matrix.equilibration();
    for (int i = 0; i < 26; ++i) {
      EXPECT_EQ(std::exp2(std::round(std::log2(scale[i]))), scale[i]);
      double largest = 0;
      for (int j = 0; j < 26; ++j) largest = std::max(largest, scale[i] * std::abs(full(i, j)) * scale[j]);
      EXPECT_GE(largest, 0.1);
      EXPECT_LE(largest, 4);
    }
  }
}

// Three relations of which one is the sum of the others in units of its own, one that is independent, and a multiplier that its
// diagonal decides: one too many.
TEST(DependentRows, AreThoseAboveTheRank) {
  const Chain chain(4, 5);
  std::vector<Coupling> couplings;
  for (std::int32_t patch = 0; patch < 5; ++patch)
    for (std::int32_t node = 0; node < 4; ++node) couplings.push_back({4 + patch, node});
  SparseMatrix matrix(chain.numbering, chain.cliques, couplings);
  const auto relate = [&](std::int64_t patch, std::vector<std::int64_t> equations, const std::vector<double>& coefficients) {
    std::vector<double> lower((equations.size() + 1) * (equations.size() + 2) / 2, 0.0);
    std::copy(coefficients.begin(), coefficients.end(), lower.end() - std::ssize(coefficients) - 1);
    equations.push_back(8 + patch);
    matrix.add(equations, lower);
  };
  relate(0, {0, 2}, {1, -1});
  relate(1, {2, 4}, {3, -3});
  relate(3, {1, 7}, {1, 2});
  matrix.add_diagonal(12, 1);
  EXPECT_EQ(count_dependent_rows(matrix, 8), 0);
  relate(2, {0, 4}, {1e6, -1e6});
  EXPECT_EQ(count_dependent_rows(matrix, 8), 1);
  EXPECT_EQ(count_dependent_rows(matrix, 8, 4), 0);  // more rows than it looks at
}

}  // namespace
}  // namespace lacon
