// Parts of a mesh: every cell once, patches whole, balanced; and what their processes put together has the bits of one process.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "hexa_block.hpp"
#include "lacon/assembly/block_numbering.hpp"
#include "lacon/assembly/parts/element_part.hpp"
#include "lacon/assembly/parts/parcel.hpp"
#include "lacon/assembly/parts/solid_parts.hpp"

namespace {

using namespace lacon;

/// A block of n x n x n HEXA8, the lower face of which is covered by slave patches of four cells each.
struct Cube : testing::Test {
  static constexpr std::int32_t n = 8;
  static constexpr test::HexaBlock block{n};
  Mesh mesh;
  std::vector<std::int32_t> cells, weight;

  static std::int32_t node(std::int32_t x, std::int32_t y, std::int32_t z) { return block.node(x, y, z); }
  static std::int32_t cell(std::int32_t x, std::int32_t y, std::int32_t z) { return block.cell(x, y, z); }
  Cube() {
    block.add_to(mesh);
    for (std::size_t i = 0; i < mesh.coordinates.size(); ++i) {
      const int at = static_cast<int>(mesh.coordinates[i]);
      mesh.coordinates[i] += 0.01 * ((7 * static_cast<int>(i / 3) + 3 * at) % 5);
    }
    for (std::int32_t c = 0; c < n * n * n; ++c) {
      cells.push_back(c);
      weight.push_back(1 + (c % n > n / 2 ? 2 : 0));
    }
    mesh.patches.emplace();
    for (std::int32_t y = 0; y < n; y += 2)
      for (std::int32_t x = 0; x < n; x += 2) {
        std::vector<std::int32_t> slaves;
        for (const auto& [i, j] : {std::pair{x, y}, {x + 1, y}, {x + 1, y + 1}, {x, y + 1}}) {
          slaves.push_back(static_cast<std::int32_t>(mesh.n_cells()));
          mesh.add_cell(CellType::QUAD4,
                        std::vector<std::int32_t>{node(i, j, 0), node(i, j + 1, 0), node(i + 1, j + 1, 0), node(i + 1, j, 0)});
        }
        mesh.patches->kind.push_back(0);
        mesh.patches->cells.push_back(slaves);
      }
  }
};

TEST_F(Cube, PartsAreBalancedAndPatchesWhole) {
  for (const int n_parts : {1, 2, 3, 5}) {
    const Partition made = partition(mesh, cells, weight, n_parts);
    ASSERT_EQ(made.of_cell.size(), cells.size());
    std::vector<int> sum(static_cast<std::size_t>(n_parts), 0);
    for (std::size_t i = 0; i < cells.size(); ++i) sum.at(static_cast<std::size_t>(made.of_cell[i])) += weight[i];
    const int all = std::accumulate(weight.begin(), weight.end(), 0), heaviest_patch = 4 * 3;
    for (const int part : sum) EXPECT_LE(part, 1.05 * all / n_parts + heaviest_patch) << n_parts;
    for (std::int32_t y = 0; y < n; y += 2)
      for (std::int32_t x = 0; x < n; x += 2) {
        std::set<std::int32_t> parts;
        for (const auto& [i, j] : {std::pair{x, y}, {x + 1, y}, {x + 1, y + 1}, {x, y + 1}})
          parts.insert(made.of_cell[static_cast<std::size_t>(cell(i, j, 0))]);
        EXPECT_EQ(parts.size(), 1) << n_parts << " parts, patch at " << x << ", " << y;
      }
    // a node belongs to a part that has one of its cells
    std::vector<std::set<std::int32_t>> around(mesh.n_nodes());
    for (std::size_t i = 0; i < cells.size(); ++i)
      for (const std::int32_t at : mesh.cells[cells[i]]) around[static_cast<std::size_t>(at)].insert(made.of_cell[i]);
    for (std::size_t at = 0; at < around.size(); ++at) EXPECT_TRUE(around[at].contains(made.of_node[at]));
    const Partition again = partition(mesh, cells, weight, n_parts);
    EXPECT_EQ(again.of_cell, made.of_cell);
    EXPECT_EQ(again.of_node, made.of_node);
  }
}

TEST_F(Cube, PartsHaveFewCommonNodes) {
  const Partition made = partition(mesh, cells, std::vector<std::int32_t>(cells.size(), 1), 2);
  std::set<std::int32_t> common;
  for (std::size_t i = 0; i < cells.size(); ++i)
    for (const std::int32_t at : mesh.cells[cells[i]])
      if (made.of_node[static_cast<std::size_t>(at)] != made.of_cell[i]) common.insert(at);
  EXPECT_LE(common.size(), 1.5 * (n + 1) * (n + 1));  // a plane across has (n + 1)^2
}

TEST_F(Cube, MorePartsThanCellsLeaveSomeEmpty) {
  const std::vector<std::int32_t> two = {cell(0, 0, 7), cell(7, 7, 7)};
  const Partition made = partition(mesh, two, std::vector<std::int32_t>{1, 1}, 3);
  EXPECT_EQ(std::set<std::int32_t>(made.of_cell.begin(), made.of_cell.end()).size(), 2);
}

TEST_F(Cube, BlocksOfAPartFollowEachOther) {
  std::vector<std::uint8_t> free(3 * mesh.n_nodes(), 1);
  for (std::size_t i = 0; i < 30; ++i) free[i] = 0;
  free[31] = 0;  // node 10 has two unknowns, those before it none
  const Numbering numbering = number_equations(static_cast<std::int64_t>(mesh.n_nodes()), 3, free, 4);
  const Partition parts = partition(mesh, cells, weight, 3);
  const BlockNumbering blocks(numbering, 3, 3, parts.of_node);
  ASSERT_EQ(blocks.first_block.size(), 4);
  EXPECT_EQ(blocks.first_block.back(), static_cast<std::int64_t>(mesh.n_nodes()) - 10);
  EXPECT_EQ(blocks.n_multipliers, 4);
  std::set<std::int32_t> places(blocks.place.begin(), blocks.place.end());
  EXPECT_EQ(places.size(), static_cast<std::size_t>(numbering.n_equations()));
  EXPECT_EQ(*places.begin(), -4);
  for (std::int32_t part = 0; part < 3; ++part)
    for (std::int64_t b = blocks.first_block[static_cast<std::size_t>(part)];
         b < blocks.first_block[static_cast<std::size_t>(part) + 1]; ++b) {
      const std::int32_t at = blocks.node[static_cast<std::size_t>(b)];
      EXPECT_EQ(parts.of_node[static_cast<std::size_t>(at)], part);
      for (int i = 0; i < 3; ++i)
        if (const std::int64_t e = numbering.of(at, i); e >= 0) {
          EXPECT_EQ(blocks.place[static_cast<std::size_t>(e)], 3 * b + i);
        }
    }
  const BlockNumbering runs(numbering, 3, 4);
  const auto n_blocks = static_cast<std::int64_t>(runs.node.size());
  EXPECT_EQ(runs.first_block, (std::vector<std::int64_t>{0, n_blocks / 4, n_blocks / 2, n_blocks * 3 / 4, n_blocks}));
  EXPECT_TRUE(std::ranges::is_sorted(runs.node));
}

/// Every other cell plastic, shaken so much that they flow.
struct Parts : Cube {
  Model model;
  MaterialField field;
  Registry registry;
  std::vector<double> displacement;
  std::vector<ElementSet> sets;
  Numbering numbering;

  Parts() {
    const auto count = mesh.n_cells();
    model.elements = {"3D/HEXA8"};
    model.element.assign(count, -1);
    std::fill_n(model.element.begin(), cells.size(), 0);
    field.materials = {"material_1"};
    field.material.assign(count, 0);
    std::vector<std::int32_t> of_cell(count, 0);
    for (std::size_t i = 0; i < cells.size(); i += 2) of_cell[i] = 1;
    const MaterialTable materials(
        field, {{{{"ELAS", {{"E", 200.0}, {"NU", 0.3}}}, {"ECRO_LINE", {{"SY", 1.0}, {"D_SIGM_EPSI", 20.0}}}}}}, {"STEEL"});
    sets = solid_sets(mesh, model, registry, materials, {{"ELAS/PETIT", "VMIS_ISOT_LINE/PETIT"}, of_cell});
    for (std::size_t i = 0; i < mesh.coordinates.size(); ++i)
      displacement.push_back(1e-3 * static_cast<double>((i * i + 3 * i) % 37));
    std::vector<std::uint8_t> free(displacement.size(), 1);
    for (std::size_t i = 0; i < 50; ++i) free[7 * i] = 0;
    numbering = number_equations(static_cast<std::int64_t>(mesh.n_nodes()), 3, free, 0);
  }
  /// All cells of a set, and none of the others.
  std::vector<CellRange> whole(std::size_t set) const {
    std::vector<CellRange> ranges(sets.size());
    ranges[set].count = sets[set].cells.size();
    return ranges;
  }
};

TEST_F(Parts, WhatProcessesPutTogetherHasTheBitsOfOne) {
  ASSERT_EQ(sets.size(), 2);
  SparseMatrix matrix(numbering, mesh.cells, {});
  std::vector<double> force(displacement.size(), 0.0);
  std::vector<std::vector<double>> stress, variable;
  std::vector<std::int64_t> equations;
  for (const ElementSet& set : sets) {
    stress.emplace_back(set.cells.size() * set.n_stress());
    variable.emplace_back(set.cells.size() * set.n_variables());
    evaluate_solids(set, mesh, {.displacement = displacement}, SolidMatrix::tangent, {stress.back(), variable.back()},
                    [&](const ElementValues& element) {
                      equations.clear();
                      for (std::size_t i = 0; i < element.dofs.size(); ++i) {
                        force[element.dofs[i]] += element.force[i];
                        equations.push_back(numbering.equation[element.dofs[i]]);
                      }
                      matrix.add(equations, element.matrix);
                    });
  }
  const std::vector<SparseMatrix::RowSize> sizes = matrix.row_sizes(matrix.size());
  const std::size_t plastic = sets[0].n_variables() > 0 ? 0 : 1;
  ASSERT_GT(*std::ranges::max_element(variable[plastic]), 0);

  for (const int n_parts : {1, 2, 3}) {
    const Partition made = partition(mesh, cells, weight, n_parts);
    // cells of the sets, one set behind the other
    Partition in_sets = made;
    std::size_t at = 0;
    for (const ElementSet& set : sets)
      for (const std::int32_t one : set.cells) in_sets.of_cell[at++] = made.of_cell[static_cast<std::size_t>(one)];
    const BlockNumbering blocks(numbering, 3, n_parts, in_sets.of_node);
    const SharedMemory memory(Board::bytes(n_parts, std::ssize(displacement)));
    const Board board = Board::in(memory, n_parts);
    std::vector<double> values(matrix.values().size(), 0.0);
    std::vector<std::vector<double>> found_stress, found_variable;
    for (const ElementSet& set : sets) {
      found_stress.emplace_back(set.cells.size() * set.n_stress(), -1e9);
      found_variable.emplace_back(set.cells.size() * set.n_variables(), -1e9);
    }
    std::vector<double> moved = displacement, x(static_cast<std::size_t>(matrix.size())), y(x.size());
    for (std::size_t dof = 0; dof < moved.size(); ++dof) {
      if (const std::int64_t e = numbering.equation[dof]; e >= 0)
        x[static_cast<std::size_t>(e)] = moved[dof];
      else
        moved[dof] = 0;
    }
    matrix.multiply(x, y);
    for (int part = 0; part < n_parts; ++part) {
      PartCells given = cells_of_part({mesh, sets, numbering, in_sets, blocks}, part);
      given.unknowns = {"DX", "DY", "DZ"};
      const std::vector<std::size_t> given_nodes(given.node.begin(), given.node.begin() + given.n_own);
      ElementPart own(std::move(given));
      PartReport& report = board.report[static_cast<std::size_t>(part)];
      std::ranges::copy(displacement, board.displacement.begin());
      own.keep(1);
      own.evaluate(board, report, SolidMatrix::tangent, 1, -1);
      ASSERT_FALSE(report.failed) << report.text;
      EXPECT_EQ(report.cell, -1);
      EXPECT_TRUE(own.flows(1));
      own.keep(2);
      EXPECT_FALSE(own.flows(2));
      own.keep_at_rest(3, 2);
      std::vector<double> rest(variable[plastic].size(), 0.0);
      own.write(3, PointQuantity::variable, whole(plastic), rest);
      for (std::size_t i = 1; i < rest.size(); i += 2) EXPECT_EQ(rest[i], 0);  // V2 is INDIPLAS
      own.drop(1);
      for (std::size_t s = 0; s < sets.size(); ++s) {
        own.write(-1, PointQuantity::stress, whole(s), found_stress[s]);
        own.write(2, PointQuantity::variable, whole(s), found_variable[s]);
      }
      own.add_to(matrix.rows(), matrix.columns(), values);
      std::ranges::copy(moved, board.displacement.begin());
      own.multiply(board, true);
      const std::vector<double> magnitudes(board.other.begin(), board.other.end());
      own.multiply(board, false);
      std::vector<double> twice, products(2 * moved.size(), 0.0);  // a column and magnitudes at once have the bits of each
      for (const double value : moved) twice.insert(twice.end(), {value, value});
      own.multiply(twice, products, 2);
      for (const std::size_t node : given_nodes)
        for (std::size_t dof = 3 * node; dof < 3 * node + 3; ++dof) {
          EXPECT_EQ(products[2 * dof], board.other[dof]);
          EXPECT_EQ(products[2 * dof + 1], magnitudes[dof]);
        }
    }
    EXPECT_TRUE(std::ranges::equal(board.force, force)) << n_parts;
    EXPECT_TRUE(std::ranges::equal(values, matrix.values())) << n_parts;
    EXPECT_EQ(found_stress, stress) << n_parts;
    EXPECT_EQ(found_variable, variable) << n_parts;
    for (std::size_t dof = 0; dof < moved.size(); ++dof)
      if (const std::int64_t e = numbering.equation[dof]; e >= 0) {
        EXPECT_NEAR(board.other[dof], y[static_cast<std::size_t>(e)], 1e-10);
      }
    for (int part = 0; part < n_parts; ++part) {
      PartCells given = cells_of_part({mesh, sets, numbering, in_sets, blocks}, part);
      given.unknowns = {"DX", "DY", "DZ"};
      ElementPart own(std::move(given));
      own.keep_natural(1);
      for (std::size_t s = 0; s < sets.size(); ++s) {  // a state that is handed in
        own.read(1, PointQuantity::stress, whole(s), stress[s]);
        own.read(1, PointQuantity::variable, whole(s), variable[s]);
      }
      std::vector<double> back = found_stress[plastic];
      std::ranges::fill(back, 0);
      own.write(1, PointQuantity::stress, whole(plastic), back);
      for (std::size_t i = 0; i < back.size(); ++i) EXPECT_TRUE(back[i] == 0 || back[i] == stress[plastic][i]);
      EXPECT_TRUE(own.flows(1));  // it has flowed there, and is natural here
      std::ranges::copy(displacement, board.displacement.begin());
      own.evaluate(board, board.report[0], SolidMatrix::tangent, -1, -1);
      own.measure(board);
    }
    for (std::size_t dof = 0; dof < displacement.size(); ++dof) {
      if (const std::int64_t e = numbering.equation[dof]; e >= 0) {
        EXPECT_NEAR(board.force[dof], sizes[static_cast<std::size_t>(e)].sum, 1e-12 * sizes[static_cast<std::size_t>(e)].sum);
        EXPECT_EQ(board.other[dof], sizes[static_cast<std::size_t>(e)].entries);
      }
    }
  }
}

// An element that its kernel refuses is told by its number in the mesh.
TEST_F(Parts, ARefusedElementIsNamedAsInTheWholeMesh) {
  const std::int32_t bad = cell(3, 4, 5);
  const auto nodes = mesh.cells[static_cast<std::size_t>(bad)];
  std::swap(nodes[0], nodes[6]);
  const Partition made = partition(mesh, cells, weight, 2);
  Partition in_sets = made;
  std::size_t at = 0;
  for (const ElementSet& set : sets)
    for (const std::int32_t one : set.cells) in_sets.of_cell[at++] = made.of_cell[static_cast<std::size_t>(one)];
  const BlockNumbering blocks(numbering, 3, 2, in_sets.of_node);
  const SharedMemory memory(Board::bytes(2, std::ssize(displacement)));
  const Board board = Board::in(memory, 2);
  const int part = made.of_cell[static_cast<std::size_t>(bad)];
  PartCells given = cells_of_part({mesh, sets, numbering, in_sets, blocks}, part);
  given.unknowns = {"DX", "DY", "DZ"};
  ElementPart own(std::move(given));
  own.evaluate(board, board.report[0], SolidMatrix::none, -1, -1);
  ASSERT_TRUE(board.report[0].failed);
  const Message said = board.report[0].message();
  EXPECT_EQ(said.id, "ELEMENT_1");
  EXPECT_NE(said.text.find(cell_name(bad)), std::string::npos) << said.text;
}

TEST(Parcel, UnpacksWhatWasPacked) {
  PartCells given{.dimension = 2,
                  .plugins = {"a", ""},
                  .unknowns = {"DX", "DY"},
                  .node = {4, 7, 1},
                  .n_own = 2,
                  .coordinates = {0.5, -1, 0},
                  .equation = {-1, 3},
                  .place = {-1, 0},
                  .sets = {{.element = "D_PLAN/QUAD4",
                            .option = "ELAS/PETIT",
                            .number = {3},
                            .at = {0},
                            .is_own = {1},
                            .nodes = {0, 1, 2, 0},
                            .parameters = {200, 0.3},
                            .curve = {}}}};
  Packing pack;
  pack(given);
  PartCells taken;
  Unpacking unpack(pack.bytes().data());
  unpack(taken);
  Packing again;
  again(taken);
  EXPECT_TRUE(std::ranges::equal(again.bytes(), pack.bytes()));
  EXPECT_EQ(taken.plugins, given.plugins);
  EXPECT_EQ(taken.sets.at(0).parameters, given.sets.at(0).parameters);
}

}  // namespace
