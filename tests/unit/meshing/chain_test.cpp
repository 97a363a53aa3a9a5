// Chains of line cells: whichever cell comes first and however each of them lies, their nodes come in the order of the line.
#include "lacon/operators/meshing/chain.hpp"

#include <algorithm>
#include <numeric>

#include "meshes.hpp"

namespace lacon::test {
namespace {

/// A line of cells from x = 0 to n_cells, in any order, each either way; quadratic ones have mid nodes.
Mesh line(std::int32_t n_cells, bool closed, bool quadratic, std::mt19937& random, Nodes& order) {
  Mesh mesh;
  const std::int32_t n_ends = n_cells + (closed ? 0 : 1);
  for (std::int32_t i = 0; i < n_ends + (quadratic ? n_cells : 0); ++i) add_node(mesh, i, 0);
  Nodes places(static_cast<std::size_t>(n_cells)), group = places;
  std::iota(places.begin(), places.end(), 0);
  std::iota(group.begin(), group.end(), 0);
  std::ranges::shuffle(places, random);
  for (const std::int32_t c : places) {
    Nodes nodes = {c, (c + 1) % n_ends};
    if (random() % 2 == 0) std::swap(nodes[0], nodes[1]);
    if (quadratic) nodes.push_back(n_ends + c);
    add(mesh, quadratic ? CellType::SEG3 : CellType::SEG2, nodes);
  }
  mesh.cell_groups = {{"LINE", group}};
  for (std::int32_t c = 0; c < n_cells; ++c) {
    order.push_back(c);
    if (quadratic) order.push_back(n_ends + c);
  }
  order.push_back(closed ? 0 : n_cells);
  return mesh;
}

TEST(Chain, has_its_nodes_in_the_direction_of_its_first_cell) {
  std::mt19937 random(9);
  for (const bool quadratic : {false, true})
    for (const std::int32_t n_cells : {1, 2, 3, 7})
      for (int trial = 0; trial < 20; ++trial) {
        Nodes expected;
        const Mesh mesh = line(n_cells, false, quadratic, random, expected);
        if (mesh.cells[0][0] > mesh.cells[0][1]) std::ranges::reverse(expected);
        EXPECT_EQ(chain_of_lines(mesh, "LINE", "GROUP_MA"), expected);
      }
}

TEST(Chain, that_is_closed_begins_and_ends_at_the_first_node_of_its_first_cell) {
  std::mt19937 random(10);
  for (const bool quadratic : {false, true})
    for (const std::int32_t n_cells : {3, 7})
      for (int trial = 0; trial < 20; ++trial) {
        Nodes ring;
        const Mesh mesh = line(n_cells, true, quadratic, random, ring);
        const std::int32_t first = mesh.cells[0][0], second = mesh.cells[0][1];
        if ((first + 1) % n_cells != second) std::ranges::reverse(ring);
        ring.pop_back();
        std::ranges::rotate(ring, std::ranges::find(ring, first));
        ring.push_back(first);
        EXPECT_EQ(chain_of_lines(mesh, "LINE", "GROUP_MA"), ring);
      }
}

}  // namespace
}  // namespace lacon::test
