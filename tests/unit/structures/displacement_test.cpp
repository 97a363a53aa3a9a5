// Displacements of nodes out of a field.
#include "lacon/structures/displacement.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace {

using testing::DoubleEq;
using testing::ElementsAre;

/// Three nodes; the field lives on the last two, and the second has no DY.
struct Displacement : testing::Test {
  lacon::Mesh mesh;
  lacon::Field field;
  Displacement() {
    mesh.dimension = 2;
    mesh.coordinates = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    field.components = {"DY", "LAGS_C", "DX"};
    field.support = {1, 2};
    field.values = {7, 9, 0.5, 0.25, 9, -0.5};
    field.present = {0, 1, 1, 1, 1, 1};
  }
};

TEST_F(Displacement, IsZeroWhereTheFieldHasNone) {
  EXPECT_THAT(lacon::nodal_displacements(mesh, field, 2), ElementsAre(0, 0, 0.5, 0, -0.5, 0.25));
  EXPECT_THAT(lacon::nodal_displacements(mesh, field, 3), ElementsAre(0, 0, 0, 0.5, 0, 0, -0.5, 0.25, 0));
}

TEST_F(Displacement, MovesCoordinates) {
  const std::vector<double> moved = {0, 0, 0, 1.5, 0, 0, -0.5, 1.25, 0};
  EXPECT_EQ(lacon::displaced(mesh, field), moved);
  std::vector<double> coordinates = {5};
  lacon::displace(mesh, lacon::nodal_displacements(mesh, field, 2), 2, coordinates);
  EXPECT_EQ(coordinates, moved);
  const std::vector<std::string> unknowns = {"DX", "DY", "LAGS_C", "TEMP"};  // more than coordinates
  lacon::displace(mesh, lacon::nodal_values(mesh, field, unknowns), 2, coordinates);
  EXPECT_EQ(coordinates, moved);
}

/// What is held of each node, in turn: its number and a vector.
std::vector<std::vector<double>> held_by(const lacon::Mesh& mesh, std::span<const lacon::Load> loads) {
  std::vector<std::vector<double>> found;
  for (const auto& [node, along] : lacon::held_directions(mesh, loads))
    found.push_back({static_cast<double>(node), along.x, along.y, along.z});
  return found;
}

TEST_F(Displacement, IsHeldWhereALoadGivesIt) {
  lacon::Load first, second;
  first.imposed = {{.place = 1, .component = "DY", .value = {}}, {.place = 2, .component = "LAGS_C", .value = {}}};
  second.imposed = {{.place = 0, .component = "DX", .value = {}}, {.place = 0, .component = "DZ", .value = {}}};
  // one node, whatever the factor; two nodes, or another unknown, hold none of them
  second.relations = {{"", {{2, "DX", -3.0}, {2, "DY", 4.0}}, {}},
                      {"", {{1, "DX", 1.0}, {2, "DX", 1.0}}, {}},
                      {"", {{1, "DX", 1.0}, {1, "LAGS_C", 1.0}}, {}}};
  EXPECT_THAT(held_by(mesh, {}), ElementsAre());
  EXPECT_THAT(held_by(mesh, std::vector{first, second}),
              ElementsAre(ElementsAre(1, 0, 1, 0), ElementsAre(0, 1, 0, 0), ElementsAre(2, DoubleEq(-0.6), DoubleEq(0.8), 0)));
}

TEST_F(Displacement, StandsBesideOtherUnknowns) {
  const std::vector<std::string> unknowns = {"DX", "DY", "LAGS_C", "TEMP"};
  EXPECT_THAT(lacon::nodal_values(mesh, field, unknowns), ElementsAre(0, 0, 0, 0, 0.5, 0, 9, 0, -0.5, 0.25, 9, 0));
}

}  // namespace
