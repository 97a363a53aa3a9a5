// DECOUPE_LAC of meshes that are put together by the input: the volume stays, the mesh conforms, patches are what the catalogue
// says.
#include "../unit/meshing/meshes.hpp"

#include "fuzz.hpp"

namespace lacon::fuzz {
namespace {

using namespace lacon::test;

void expect_sound(const Mesh& mesh, const std::vector<std::string>& groups, std::string_view option) {
  const Mesh made = cut(mesh, groups, option);
  expect(std::abs(total_measure(made) - total_measure(mesh)) <= 1e-13 * total_measure(mesh), "a cut keeps the volume");
  expect_sound_cut(mesh, made, groups);
  expect(!testing::Test::HasFailure(), "a cut is sound");
}

void in_plane(Choices& choices) {
  constexpr CellType types[] = {CellType::TRIA3, CellType::QUAD4, CellType::TRIA6, CellType::QUAD8, CellType::QUAD9};
  const CellType type = types[choices.below(std::size(types))];
  const int n = choices.between(1, 4), m = choices.between(1, 4), sides = choices.below(16);
  const Mesh mesh = block(type, n, m, choices.word());
  constexpr const char* names[] = {"LEFT", "TOP", "RIGHT", "BOTTOM"};
  std::vector<std::string> groups;
  for (int k = 0; k < 4; ++k)
    if (sides >> k & 1) groups.emplace_back(names[k]);
  if (!groups.empty()) expect_sound(mesh, groups, "PYRA");
}

void in_space(Choices& choices) {
  struct Pair {
    CellType skin, body;
  };
  constexpr Pair pairs[] = {
      {CellType::TRIA3, CellType::TETRA4}, {CellType::TRIA6, CellType::TETRA10}, {CellType::QUAD4, CellType::HEXA8},
      {CellType::QUAD8, CellType::HEXA20}, {CellType::QUAD9, CellType::HEXA27},  {CellType::TRIA3, CellType::PENTA6},
      {CellType::QUAD4, CellType::PENTA6}, {CellType::TRIA3, CellType::PYRAM5},  {CellType::QUAD4, CellType::PYRAM5}};
  const auto [skin, body] = pairs[choices.below(std::size(pairs))];
  Mesh mesh = one_cell(body, skin, choices.word());
  std::vector<std::int32_t>& slaves = mesh.cell_groups[0].members;
  std::vector<std::int32_t> some;
  const int chosen = choices.byte();
  for (std::size_t i = 0; i < slaves.size(); ++i)
    if (chosen >> i & 1) some.push_back(slaves[i]);
  if (some.empty()) return;
  slaves = some;
  // a hexahedron is cut into hexahedra at one face alone
  expect_sound(mesh, {"SKIN"}, slaves.size() == 1 && choices.below(2) == 0 ? "HEXA" : "PYRA");
}

}  // namespace

void cuts(Bytes input) {
  Choices choices(input);
  choices.below(2) == 0 ? in_plane(choices) : in_space(choices);
}

}  // namespace lacon::fuzz
