// DECOUPE_LAC of whatever is given: the cut keeps the volume and conforms. rapidcheck looks for the smallest mesh that breaks
// it.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "meshes.hpp"

namespace {

using namespace lacon;
using namespace lacon::test;

void expect_volume_and_conformity(const Mesh& mesh, const std::vector<std::string>& groups, const std::string& option) {
  const Mesh made = cut(mesh, groups, option);
  RC_ASSERT(std::abs(total_measure(made) - total_measure(mesh)) <= 1e-13 * total_measure(mesh));
  expect_sound_cut(mesh, made, groups);
  RC_ASSERT(!testing::Test::HasFailure());
}

RC_GTEST_PROP(CutProperties, BlocksOfThePlaneWithAnySlaveEdges, ()) {
  const CellType type = *rc::gen::element(CellType::TRIA3, CellType::QUAD4, CellType::TRIA6, CellType::QUAD8, CellType::QUAD9);
  Mesh mesh = block(type, *rc::gen::inRange(1, 6), *rc::gen::inRange(1, 6), *rc::gen::arbitrary<unsigned>());
  std::vector<std::string> groups;
  for (const char* side : {"LEFT", "TOP", "RIGHT", "BOTTOM"})
    if (*rc::gen::arbitrary<bool>()) groups.emplace_back(side);
  RC_PRE(!groups.empty());
  expect_volume_and_conformity(mesh, groups, "PYRA");
}

RC_GTEST_PROP(CutProperties, CellsOfSpaceWithAnySlaveFaces, ()) {
  struct Pair {
    CellType skin, body;
  };
  const auto [skin, body] = *rc::gen::elementOf(std::vector<Pair>{{CellType::TRIA3, CellType::TETRA4},
                                                                  {CellType::TRIA6, CellType::TETRA10},
                                                                  {CellType::QUAD4, CellType::HEXA8},
                                                                  {CellType::QUAD8, CellType::HEXA20},
                                                                  {CellType::QUAD9, CellType::HEXA27},
                                                                  {CellType::TRIA3, CellType::PENTA6},
                                                                  {CellType::QUAD4, CellType::PENTA6},
                                                                  {CellType::TRIA3, CellType::PYRAM5},
                                                                  {CellType::QUAD4, CellType::PYRAM5}});
  Mesh mesh = one_cell(body, skin, *rc::gen::inRange(0u, 100000u));
  std::vector<std::int32_t>& slaves = mesh.cell_groups[0].members;
  slaves = *rc::gen::suchThat(rc::gen::container<std::vector<std::int32_t>>(rc::gen::elementOf(slaves)),
                              [](const std::vector<std::int32_t>& some) { return !some.empty(); });
  std::sort(slaves.begin(), slaves.end());
  slaves.erase(std::unique(slaves.begin(), slaves.end()), slaves.end());
  // a hexahedron is cut into hexahedra at one face alone
  expect_volume_and_conformity(mesh, {"SKIN"}, slaves.size() == 1 && *rc::gen::arbitrary<bool>() ? "HEXA" : "PYRA");
}

}  // namespace
