#include "lacon/assembly/petsc/block_rows.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <vector>

namespace lacon {
namespace {

/// Two bars of two nodes in the plane, and a multiplier that holds the end of one to the beginning of the other.
struct TwoBars {
  std::vector<std::int64_t> row{0}, first_block{0, 4};
  std::vector<double> value, coordinates{0, 0, 1, 0, 1, 0, 2, 0};
  std::vector<std::int32_t> place, column;
  BlockSystem system;
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(8, 8);

  /// @param imposed a row of the displacements that no equation has  @param has_bodies whether their entries are in the system
  explicit TwoBars(int imposed = -1, bool has_bodies = true) {
    stiffness.block<4, 4>(0, 0) << 4, 1, -3, 0, 1, 5, 0, -2, -3, 0, 6, 1, 0, -2, 1, 7;
    stiffness.block<4, 4>(4, 4) = 2 * stiffness.block<4, 4>(0, 0);
    for (int i = 0; i < 9; ++i) {
      if (i == imposed) continue;
      for (int j = 0, equation = 0; j <= i; ++j) {
        if (j == imposed) continue;
        const double entry = i < 8 ? (has_bodies ? stiffness(i, j) : 0) : j == 2 ? 1 : j == 4 ? -1 : 0;
        if (entry != 0) {
          column.push_back(equation);
          value.push_back(entry);
        }
        ++equation;
      }
      place.push_back(i < 8 ? i : -1);
      row.push_back(std::ssize(column));
    }
    system = {
        .sizes = {.n = std::ssize(place), .n_entries = std::ssize(column), .n_blocks = 4, .n_multipliers = 1, .dimension = 2},
        .row = row,
        .value = value,
        .coordinates = coordinates,
        .first_block = first_block,
        .place = place,
        .column = column};
  }
};

// Half of K + B W C, from the diagonal on and row by row; what the multiplier's weight alone makes is no link.
TEST(BlockRows, AreHalfOfASymmetricMatrixAndSayWhatIsABodys) {
  const TwoBars bars;
  const BlockRows rows = rows_of_part(bars.system, {}, 0);
  ASSERT_TRUE(rows.k.own.is_half);
  Eigen::VectorXd c = Eigen::VectorXd::Zero(8);
  c[2] = 1, c[4] = -1;
  c *= rows.scale[0];
  const Eigen::MatrixXd expected = bars.stiffness + rows.weight[0] * c * c.transpose();
  Eigen::MatrixXd found = Eigen::MatrixXd::Zero(8, 8);
  std::vector<std::pair<int, int>> links, others;
  for (int i = 0; i < 4; ++i)
    for (std::int32_t k = rows.k.own.offset[i]; k < rows.k.own.offset[i + 1]; ++k) {
      const std::int32_t j = rows.k.own.column[k];
      ASSERT_GE(j, i);
      (rows.is_of_k[k] ? links : others).emplace_back(i, j);
      for (int r = 0; r < 2; ++r)
        for (int s = 0; s < 2; ++s)
          found(2 * i + r, 2 * j + s) = found(2 * j + s, 2 * i + r) = rows.k.own.value[k * 4 + r * 2 + s];
    }
  EXPECT_GT(rows.weight[0], 0);
  EXPECT_LE((found - expected).cwiseAbs().maxCoeff(), 1e-14 * expected.cwiseAbs().maxCoeff());
  EXPECT_EQ(links, (std::vector<std::pair<int, int>>{{0, 0}, {0, 1}, {1, 1}, {2, 2}, {2, 3}, {3, 3}}));
  EXPECT_EQ(others, (std::vector<std::pair<int, int>>{{1, 2}}));
}

// Its nodes stand in another order than the blocks.
TEST(BlockRows, AreTheSameWhereAProcessHasTheBodiesItself) {
  for (const int imposed : {-1, 5}) {
    const TwoBars whole(imposed), here(imposed, false);
    const std::vector<std::int32_t> block_of{3, 1, 0, 2};
    const Numbering numbering = number_equations(4, 2, std::vector<std::uint8_t>(8, 1), 0);
    Ragged<std::int32_t> bars;
    for (const std::vector<std::int32_t>& nodes : {std::vector{2, 1}, std::vector{3, 0}}) bars.push_back(nodes);
    SparseMatrix matrix(numbering, bars, {});
    std::vector<std::int32_t> place(8);
    for (int i = 0; i < 8; ++i) place[i] = 2 * block_of[i / 2] + i % 2;
    for (int bar = 0; bar < 2; ++bar) {
      std::vector<std::int64_t> equations;
      for (const std::int32_t node : bars[bar])
        for (int i = 0; i < 2; ++i) equations.push_back(2 * node + i);
      std::vector<double> lower;
      for (int i = 0; i < 4; ++i)
        for (int j = 0; j <= i; ++j) lower.push_back(whole.stiffness(place[equations[i]], place[equations[j]]));
      matrix.add(equations, lower);
    }
    OwnEntries own{.matrix = &matrix, .place = place, .diagonal = std::vector<double>(8)};
    for (std::int32_t& at : place)
      if (at == imposed)
        at = -1;
      else
        own.diagonal[at] = whole.stiffness(at, at);
    const BlockRows expected = rows_of_part(whole.system, {}, 0), found = rows_of_part(here.system, own, 0);
    EXPECT_EQ(found.k.own.offset, expected.k.own.offset);
    EXPECT_EQ(found.k.own.column, expected.k.own.column);
    EXPECT_EQ(found.k.own.value, expected.k.own.value);
    EXPECT_EQ(found.is_of_k, expected.is_of_k);
    EXPECT_EQ(found.is, expected.is);
    EXPECT_EQ(found.b.value, expected.b.value);
    EXPECT_EQ(found.schur, expected.schur);
  }
}

}  // namespace
}  // namespace lacon
