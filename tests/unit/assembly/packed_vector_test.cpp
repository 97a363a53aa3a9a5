// Vectors in whole numbers of 16 bits: how exact they are, and what is done with them.
#include <gtest/gtest.h>

#include <random>

#include "lacon/assembly/packed_vector.hpp"

namespace lacon {
namespace {

constexpr std::size_t block = PackedVector::block;

std::vector<float> unpacked(const PackedVector& packed) {
  std::vector<float> values(packed.size(), 0.0F);
  packed.add_to(values, 0, 1);
  return values;
}

// Half a unit, which is the largest entry of the block over 2^15 - 1, and the last digit of single precision: whatever the size
// of numbers in other blocks.
TEST(PackedVector, IsOffByHalfAUnitOfEachBlock) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> part(-1, 1);
  std::vector<float> values(3 * block + 17);
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = part(random) * std::pow(10.0F, static_cast<float>(i / block) * 9 - 20);
  const std::vector<float> found = unpacked(PackedVector(values));
  for (std::size_t i = 0; i < values.size(); ++i) {
    float largest = 0;
    for (std::size_t k = i / block * block; k < std::min(values.size(), (i / block + 1) * block); ++k)
      largest = std::max(largest, std::abs(values[k]));
    EXPECT_LE(std::abs(found[i] - values[i]), (0.5F / INT16_MAX + 2e-7F) * largest) << i;
  }
}

TEST(PackedVector, KeepsZerosAndTheLargest) {
  std::vector<float> values(2 * block, 0.0F);
  values[3] = -7.25F;
  values[4] = 7.25F;
  const std::vector<float> found = unpacked(PackedVector(values));
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_NEAR(found[i], values[i], 1e-6) << i;
  EXPECT_EQ(found[block + 1], 0);
  const std::vector<float> none = unpacked(PackedVector(std::vector<float>(5, 1e-44F)));  // less than a unit can be
  EXPECT_EQ(none, std::vector<float>(5, 0.0F));
}

TEST(PackedVector, AddsAMultipleOfAPart) {
  std::vector<float> values(3 * block);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i % 7) - 3;
  const PackedVector packed(values);
  std::vector<float> sum(block + 5, 2.0F);
  packed.add_to(sum, 2 * block - block, -0.5F);
  for (std::size_t i = 0; i < sum.size(); ++i) EXPECT_NEAR(sum[i], 2 - 0.5F * values[block + i], 1e-4) << i;
}

TEST(PackedVector, TakesHalfTheMemory) {
  EXPECT_EQ(PackedVector::memory(1000 * block), 1000 * (block * 2 + 4));
  EXPECT_EQ(PackedVector::memory(1), 2 + 4);
  EXPECT_TRUE(PackedVector().empty());
}

}  // namespace
}  // namespace lacon
