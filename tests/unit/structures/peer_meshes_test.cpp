// The peer's own meshes read with the counts that peer_meshes.json lists: nodes, cells by type, groups by type.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "lacon/structures/formats/med.hpp"

namespace {

using namespace lacon;
using Counts = std::map<std::string, int>;

nlohmann::json expected() {
  std::ifstream file(LACON_SOURCE_DIR "/tests/unit/structures/peer_meshes.json");
  return nlohmann::json::parse(file);
}

Counts count_types(const Mesh& mesh, const std::vector<std::int32_t>& cells) {
  Counts counts;
  for (std::int32_t cell : cells) ++counts[std::string(mesh.row(static_cast<std::size_t>(cell)).med_name)];
  return counts;
}

class PeerMesh : public testing::TestWithParam<std::string> {};

TEST_P(PeerMesh, reads_with_the_known_counts) {
  const std::filesystem::path file = std::filesystem::path(LACON_SHARED_CASES) / "meshes" / GetParam();
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no " << file << " (set LACON_SHARED_CASES)";
  const nlohmann::json row = expected().at(GetParam());
  const Mesh mesh = read_med_mesh(file);
  EXPECT_EQ(mesh.name, row.at("mesh").get<std::string>());
  EXPECT_EQ(mesh.n_nodes(), row.at("nodes").get<std::size_t>());
  std::vector<std::int32_t> all(mesh.n_cells());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::int32_t>(i);
  EXPECT_EQ(count_types(mesh, all), row.at("cells").get<Counts>());
  EXPECT_TRUE(std::is_sorted(mesh.types.begin(), mesh.types.end()));

  std::map<std::string, Counts> cell_groups;
  for (const Group& group : mesh.cell_groups)
    if (!group.members.empty()) cell_groups[group.name] = count_types(mesh, group.members);
  EXPECT_EQ(cell_groups, (row.at("cell_groups").get<std::map<std::string, Counts>>()));
  Counts node_groups;
  for (const Group& group : mesh.node_groups)
    if (!group.members.empty()) node_groups[group.name] = static_cast<int>(group.members.size());
  EXPECT_EQ(node_groups, row.at("node_groups").get<Counts>());

  const auto box = row.at("box").get<std::vector<std::array<double, 2>>>();  // rounded to three digits
  for (std::size_t k = 0; k < box.size(); ++k) {
    double low = INFINITY, high = -INFINITY;
    for (std::size_t i = 0; i < mesh.n_nodes(); ++i) {
      low = std::min(low, mesh.coordinates[3 * i + k]);
      high = std::max(high, mesh.coordinates[3 * i + k]);
    }
    EXPECT_NEAR(low, box[k][0], 1e-3 * std::max(1.0, std::abs(box[k][0])));
    EXPECT_NEAR(high, box[k][1], 1e-3 * std::max(1.0, std::abs(box[k][1])));
  }
}

/// A mid node lies nearer to the middle of its edge's vertices, in our numbering, than to that of any other edge: the node
/// permutation of catalog/cells.toml is the right one. (Not exactly at the middle: edges of these meshes are curved.)
TEST_P(PeerMesh, has_mid_nodes_on_their_edges) {
  const std::filesystem::path file = std::filesystem::path(LACON_SHARED_CASES) / "meshes" / GetParam();
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no " << file << " (set LACON_SHARED_CASES)";
  const Mesh mesh = read_med_mesh(file);
  const auto distance = [&](std::span<const std::int32_t> nodes, const catalog::EdgeRow& edge, std::int32_t node) {
    double square = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto x = [&](std::int32_t i) { return mesh.coordinates[3 * static_cast<std::size_t>(i) + k]; };
      square += std::pow(0.5 * (x(nodes[edge.first]) + x(nodes[edge.second])) - x(node), 2);
    }
    return std::sqrt(square);
  };
  int wrong = 0;
  for (std::size_t c = 0; c < mesh.n_cells(); ++c) {
    const catalog::CellRow& row = mesh.row(c);
    if (row.order < 2 || row.dimension < 2) continue;
    for (std::size_t e = 0; e < row.edges.size(); ++e) {
      const std::int32_t node = mesh.cells[c][static_cast<std::size_t>(row.n_vertices) + e];
      for (const catalog::EdgeRow& other : row.edges)
        if (distance(mesh.cells[c], other, node) < distance(mesh.cells[c], row.edges[e], node)) ++wrong;
    }
  }
  EXPECT_EQ(wrong, 0);
}

std::vector<std::string> names() {
  std::vector<std::string> list;
  const nlohmann::json rows = expected();
  for (const auto& [name, row] : rows.items()) list.push_back(name);
  return list;
}

INSTANTIATE_TEST_SUITE_P(all, PeerMesh, testing::ValuesIn(names()), [](const auto& parameter) {
  std::string name = parameter.param;
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
});

}  // namespace
