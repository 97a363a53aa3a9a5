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
  std::vector<std::int32_t> place{0, 1, 2, 3, 4, 5, 6, 7, -1}, column;
  BlockSystem system;
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(8, 8);

  TwoBars() {
    stiffness.block<4, 4>(0, 0) << 4, 1, -3, 0, 1, 5, 0, -2, -3, 0, 6, 1, 0, -2, 1, 7;
    stiffness.block<4, 4>(4, 4) = 2 * stiffness.block<4, 4>(0, 0);
    for (int i = 0; i < 9; ++i) {
      for (int j = 0; j <= i; ++j)
        if (const double entry = i < 8 ? stiffness(i, j) : j == 2 ? 1 : j == 4 ? -1 : 0; entry != 0) {
          column.push_back(j);
          value.push_back(entry);
        }
      row.push_back(std::ssize(column));
    }
    system = {.sizes = {.n = 9, .n_entries = std::ssize(column), .n_blocks = 4, .n_multipliers = 1, .dimension = 2},
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

}  // namespace
}  // namespace lacon
