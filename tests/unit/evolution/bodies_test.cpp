#include "lacon/structures/bodies.hpp"

#include <gtest/gtest.h>

#include "two_squares.hpp"

namespace lacon {
namespace {

// Two squares that share no node: the lower one has a group, the upper one has none that is all inside it.
TEST(Bodies, AreWhatCellsHoldTogetherAndHaveTheNameOfTheirLargestGroup) {
  Mesh mesh = test::two_squares("ELAS/PETIT", false).mesh;
  mesh.cell_groups = {{"SKIN", {test::master_skin}},
                      {"LOWER", {test::lower_body}},
                      {"ALL", {test::lower_body, test::upper_body}},
                      {"NOTHING", {}}};
  const Bodies bodies(mesh);
  for (std::int32_t node = 0; node < 16; ++node) EXPECT_EQ(bodies.of(node), node < 8 ? 0 : 8);
  EXPECT_EQ(bodies.name_at(3), "LOWER");
  EXPECT_EQ(bodies.name_at(12), "the body of " + cell_name(test::upper_body));
}

}  // namespace
}  // namespace lacon
