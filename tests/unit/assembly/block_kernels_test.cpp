#include "lacon/assembly/petsc/block_kernels.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <limits>
#include <random>
#include <utility>

namespace lacon {
namespace {

constexpr int block_rows = 7, block_columns = 5;  // of blocks

/// Some of the blocks, and the matrix that they are.
template <class Real>
struct Example {
  Example(int rows, int columns) : dense(Eigen::MatrixXd::Zero(block_rows * rows, block_columns * columns)) {
    std::mt19937 random(7);
    std::uniform_real_distribution<Real> entry(-1, 1);
    blocks.rows = rows;
    blocks.columns = columns;
    for (int i = 0; i < block_rows; ++i) {
      for (int j = 0; j < block_columns; ++j) {
        if (i == 3 || (i + 2 * j) % 3 == 0) continue;  // a row has none at all
        blocks.column.push_back(j);
        for (int c = 0; c < columns; ++c)
          for (int r = 0; r < rows; ++r) {
            blocks.value.push_back(entry(random));
            dense(i * rows + r, j * columns + c) = blocks.value.back();
          }
      }
      blocks.offset.push_back(static_cast<std::int32_t>(blocks.column.size()));
    }
    blocks.value.insert(blocks.value.end(), read_behind, std::numeric_limits<Real>::quiet_NaN());  // counts for nothing
  }
  BlockEntries<Real> blocks;
  Eigen::MatrixXd dense;
};

// Products are those of the whole matrix, in double precision whatever the entries are in, and nothing behind the blocks gets
// into them.
template <class Real>
void expect_products(const BlockKernels<Real>* kernels, int rows, int columns) {
  ASSERT_NE(kernels, nullptr);
  const Example<Real> example(rows, columns);
  const Eigen::VectorXd x = Eigen::VectorXd::Random(block_columns * columns), z = Eigen::VectorXd::Random(block_rows * rows);
  Eigen::VectorXd y = z;
  const double exact = 1e-14;
  kernels->multiply(example.blocks, x.data(), y.data());
  EXPECT_LE((y - example.dense * x).cwiseAbs().maxCoeff(), exact);
  y = z;
  kernels->add(example.blocks, x.data(), y.data());
  EXPECT_LE((y - z - example.dense * x).cwiseAbs().maxCoeff(), exact);
  y = x;
  kernels->add_transposed(example.blocks, z.data(), y.data());
  EXPECT_LE((y - x - example.dense.transpose() * z).cwiseAbs().maxCoeff(), exact);
}

TEST(BlockKernels, MultiplyAsTheWholeMatrix) {
  for (const auto& [rows, columns] : {std::pair(2, 2), std::pair(2, 3), std::pair(3, 3), std::pair(3, 6), std::pair(6, 6)})
    expect_products(single_kernels(rows, columns), rows, columns);
  for (const int size : {2, 3}) expect_products(double_kernels(size, size), size, size);
}

/// A symmetric matrix of which half is there, in rows of blocks from the diagonal on.
template <class Real>
struct HalfExample {
  explicit HalfExample(int size) : dense(Eigen::MatrixXd::Zero(block_rows * size, block_rows * size)) {
    std::mt19937 random(8);
    std::uniform_real_distribution<Real> entry(-1, 1);
    blocks.rows = blocks.columns = size;
    blocks.is_half = true;
    for (int i = 0; i < block_rows; ++i) {
      for (int j = i; j < block_rows; ++j) {
        if (j != i && (i + j) % 3 == 0) continue;
        blocks.column.push_back(j);
        for (int r = 0; r < size; ++r)
          for (int c = 0; c < size; ++c) {
            const Real value = j == i && c < r ? static_cast<Real>(dense(i * size + r, j * size + c)) : entry(random);
            blocks.value.push_back(value);
            dense(i * size + r, j * size + c) = dense(j * size + c, i * size + r) = value;
          }
      }
      blocks.offset.push_back(static_cast<std::int32_t>(blocks.column.size()));
    }
    blocks.value.insert(blocks.value.end(), read_behind, std::numeric_limits<Real>::max() / 4);  // counts for nothing
  }
  BlockEntries<Real> blocks;
  Eigen::MatrixXd dense;
};

Eigen::VectorXd padded(const Eigen::VectorXd& x, int size) {
  Eigen::VectorXd made = Eigen::VectorXd::Zero(x.size() / size * padded_size);
  for (Eigen::Index i = 0; i < x.size(); ++i) made[i / size * padded_size + i % size] = x[i];
  return made;
}

template <class Real>
void expect_product_of_half(const BlockKernels<Real>* kernels, int size) {
  ASSERT_NE(kernels, nullptr);
  const HalfExample<Real> example(size);
  const Eigen::VectorXd x = Eigen::VectorXd::Random(block_rows * size), y = Eigen::VectorXd::Random(block_rows * size);
  const Eigen::VectorXd there = padded(x, size), expected = y + example.dense * x;
  Eigen::VectorXd sum = padded(y, size);
  kernels->add_half(example.blocks, there.data(), sum.data());
  for (Eigen::Index i = 0; i < x.size(); ++i) EXPECT_NEAR(sum[i / size * padded_size + i % size], expected[i], 1e-14);
}

TEST(BlockKernels, HalfASymmetricMatrixIsAsGood) {
  for (const int size : {2, 3}) {
    expect_product_of_half(single_kernels(size, size), size);
    expect_product_of_half(double_kernels(size, size), size);
  }
  EXPECT_EQ(single_kernels(3, 6)->add_half, nullptr);
}

TEST(BlockKernels, AreNotThereForOtherBlocks) {
  EXPECT_EQ(single_kernels(6, 5), nullptr);
  EXPECT_EQ(double_kernels(6, 6), nullptr);
}

}  // namespace
}  // namespace lacon
