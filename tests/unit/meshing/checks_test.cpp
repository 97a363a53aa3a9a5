// VERI_MAIL against its definition, cell by cell, on random cells of every kind.
#include "lacon/operators/meshing/checks.hpp"

#include <functional>
#include <numeric>

#include "meshes.hpp"

namespace {

using namespace lacon;
using namespace lacon::test;

/// What `id` said: "<count> ... (M1, M2, ...)", or nothing. @param numbers 0-based, ascending
void expect_told(const std::string& id, const Nodes& numbers, const std::function<std::string(std::int64_t)>& name) {
  const auto said = std::ranges::find(Listener::heard(), id, &Message::id);
  ASSERT_EQ(said != Listener::heard().end(), !numbers.empty()) << id;
  if (numbers.empty()) return;
  std::string some;
  for (std::size_t i = 0; i < std::min<std::size_t>(5, numbers.size()); ++i) some += (i > 0 ? ", " : "") + name(numbers[i]);
  EXPECT_TRUE(said->text.starts_with(std::to_string(numbers.size()) + " ")) << said->text;
  EXPECT_NE(said->text.find("(" + some + (numbers.size() > 5 ? ", ...)" : ")")), std::string::npos) << said->text;
}

TEST(Checks, find_orphans_twins_and_flat_cells_as_brute_force_does) {
  std::mt19937 random(7);
  for (const std::size_t n_cells : {40u, 2000u}) {
    Mesh mesh;
    std::uniform_real_distribution<double> place(0, 1);
    for (int n = 0; n < 300; ++n) {
      const double x = place(random);
      add_node(mesh, x, place(random) * (n % 3 == 0 ? 1e-2 : 1), place(random));
    }
    Nodes all(299);  // the last one belongs to no cell
    std::iota(all.begin(), all.end(), 0);
    while (mesh.n_cells() < n_cells) {
      const std::size_t some = random();
      if (mesh.n_cells() > 0 && some % 4 == 0) {  // the nodes of another cell, turned around
        const std::size_t other = some / 4 % mesh.n_cells();
        Nodes nodes(mesh.cells[other].begin(), mesh.cells[other].end());
        std::ranges::shuffle(nodes, random);
        mesh.add_cell(mesh.types[other], nodes);
        continue;
      }
      const catalog::CellRow& row = catalog::cells()[random() % catalog::cells().size()];
      std::ranges::shuffle(all, random);
      mesh.add_cell(row.type, Nodes(all.begin(), all.begin() + row.n_nodes));
    }

    std::set<std::int32_t> used(mesh.cells.values.begin(), mesh.cells.values.end());
    Nodes orphans, twins, flat;
    for (std::int32_t n = 0; n < 300; ++n)
      if (!used.contains(n)) orphans.push_back(n);
    std::set<std::set<std::int32_t>> seen;
    constexpr double flatness = 0.2;
    for (std::size_t c = 0; c < mesh.n_cells(); ++c) {
      const auto nodes = mesh.cells[c];
      if (!seen.insert(std::set(nodes.begin(), nodes.end())).second) twins.push_back(static_cast<std::int32_t>(c));
      double least = INFINITY, greatest = 0;
      for (std::int32_t i = 0; i < mesh.row(c).n_vertices; ++i)
        for (std::int32_t j = 0; j < i; ++j) {
          const auto a = mesh.point(static_cast<std::size_t>(nodes[i])), b = mesh.point(static_cast<std::size_t>(nodes[j]));
          const double distance = std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
          least = std::min(least, distance);
          greatest = std::max(greatest, distance);
        }
      if (mesh.row(c).n_vertices > 1 && least <= flatness * greatest) flat.push_back(static_cast<std::int32_t>(c));
    }
    EXPECT_GT(twins.size(), n_cells / 8);
    EXPECT_GT(flat.size(), n_cells / 50);
    EXPECT_LT(flat.size(), n_cells / 2);

    const Listener listener;
    inspect(mesh, flatness);
    expect_told("LIRE_3", orphans, node_name);
    const auto first_body = std::ranges::stable_partition(twins, [&](std::int32_t cell) {
                              return mesh.row(static_cast<std::size_t>(cell)).dimension < mesh.dimension;
                            }).begin();
    expect_told("LIRE_4", {twins.begin(), first_body}, cell_name);
    expect_told("LIRE_7", {first_body, twins.end()}, cell_name);
    expect_told("LIRE_5", flat, cell_name);
  }
}

// Its corners are the right way round, and in its middle the map is singular.
TEST(Orientation, a_hexahedron_with_a_turned_face_is_refused) {
  Mesh mesh = one_cell(CellType::HEXA8, CellType::QUAD4, 3);
  const Nodes nodes(mesh.cells[0].begin(), mesh.cells[0].end());
  EXPECT_EQ(error_of([&] { orient_body_cells(mesh); }).id, "");
  for (const int by : {1, 2, 3}) {
    for (std::size_t v = 0; v < 4; ++v) mesh.cells[0][4 + v] = nodes[4 + (v + static_cast<std::size_t>(by)) % 4];
    if (by == 2) {
      EXPECT_GT(jacobian_range(CellType::HEXA8, mesh.cells[0], mesh.coordinates).least, -1e-12);
    }
    const bool is_refused = error_of([&] { orient_body_cells(mesh); }).id == "LIRE_2";
    EXPECT_EQ(is_refused, by == 2) << by;
  }
}

}  // namespace
