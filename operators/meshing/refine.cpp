#include "lacon/operators/meshing/refine.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/refinements.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/operators/meshing/body.hpp"
#include "lacon/operators/meshing/checks.hpp"
#include "lacon/operators/meshing/quality.hpp"
#include "lacon/operators/meshing/subdivision.hpp"

namespace lacon {
namespace {

using Nodes = std::vector<std::int32_t>;

/// Diagonals whose squared lengths differ by less, relatively, are equally long.
constexpr double equal_lengths = 1e-9;

using Edge = std::pair<std::int32_t, std::int32_t>;

/// The vertices of each edge of a cell, the lower number first.
std::vector<Edge> edges_of(const Mesh& mesh, std::size_t cell) {
  std::vector<Edge> edges;
  const auto nodes = mesh.cells[cell];
  for (const catalog::EdgeRow& edge : mesh.row(cell).edges)
    edges.push_back(std::minmax({nodes[static_cast<std::size_t>(edge.first)], nodes[static_cast<std::size_t>(edge.second)]}));
  return edges;
}

/// Which cells are refined: those of the groups (none: all), and the facets and edges of theirs.
std::vector<char> chosen(const Mesh& mesh, std::span<const std::string> groups, const std::string& keyword,
                         RefinementReport& report) {
  std::vector<char> mark(mesh.n_cells(), groups.empty());
  for (const std::string& group : groups)
    for (const std::int32_t c : cells_of_group(mesh, group, keyword)) mark[static_cast<std::size_t>(c)] = 1;
  for (std::size_t c = 0; c < mesh.n_cells(); ++c)
    if (!catalog::find_refinement(mesh.types[c])) mark[c] = 0;  // a point stays

  std::set<Edge> cut;
  for (std::size_t c = 0; c < mesh.n_cells(); ++c)
    if (mark[c])
      for (const Edge& edge : edges_of(mesh, c)) cut.insert(edge);
  const NodeCells around(mesh);
  for (std::size_t c = 0; c < mesh.n_cells(); ++c) {
    if (mark[c]) continue;
    const std::vector<Edge> own = edges_of(mesh, c);
    if (std::ranges::none_of(own, [&](const Edge& edge) { return cut.contains(edge); })) continue;
    const bool is_edge = mesh.row(c).dimension == 1;
    const bool is_facet = mesh.row(c).dimension == 2 &&
                          std::ranges::any_of(body_cells(mesh, around, c),
                                              [&](const BodyCell& b) { return mark[static_cast<std::size_t>(b.cell)] == 1; });
    if (!is_edge && !is_facet) continue;
    mark[c] = 2;
    ++report.attached;
  }
  for (std::size_t c = 0; c < mesh.n_cells(); ++c)
    for (const Edge& edge : edges_of(mesh, c))
      if (!mark[c] && cut.contains(edge)) {
        const std::string names = groups_with(mesh, static_cast<std::int32_t>(c));
        fail("RAFFINE_1", {{"keyword", keyword},
                           {"cell", cell_name(static_cast<std::int64_t>(c))},
                           {"type", std::string(mesh.row(c).name)},
                           {"groups", names.empty() ? "" : part("of_the_group", {{"groups", names}})},
                           {"first", node_name(edge.first)},
                           {"second", node_name(edge.second)}});
      }
  report.refined = std::ranges::count_if(mark, [](char m) { return m != 0; });
  return mark;
}

/// Nodes by the weights of the vertices whose mean they are: two cells that share a facet share its points.
class Points {
 public:
  explicit Points(std::vector<double>& coordinates) : coordinates_(coordinates) {}

  /// The nodes of all points of a row that `used` names, in a cell with these nodes; new ones are appended. Others: -1.
  Nodes of(const catalog::RefinementRow& row, std::span<const std::int32_t> nodes, const std::vector<char>& used) {
    Nodes all(used.size(), -1);
    const auto d = static_cast<std::size_t>(catalog::cell(row.cell).dimension);
    for (std::size_t p = 0; p < all.size(); ++p) {
      if (!used[p]) continue;
      const auto [at, fresh] = known_.emplace(key(row, nodes, p), static_cast<std::int32_t>(coordinates_.size() / 3));
      if (fresh) {
        const auto point = image(row.cell, nodes, row.points.subspan(p * d, d), coordinates_);
        coordinates_.insert(coordinates_.end(), point.begin(), point.end());
      }
      all[p] = at->second;
    }
    return all;
  }

  /// Enter the cell's own nodes. A node stays itself where another cell has its own at the same place.
  void enter(const catalog::RefinementRow& row, std::span<const std::int32_t> nodes) {
    for (std::size_t p = 0; p < nodes.size(); ++p) known_.emplace(key(row, nodes, p), nodes[p]);
  }

 private:
  using Key = std::vector<std::pair<std::int32_t, std::int8_t>>;

  static Key key(const catalog::RefinementRow& row, std::span<const std::int32_t> nodes, std::size_t point) {
    const auto n = static_cast<std::size_t>(catalog::cell(row.cell).n_vertices);
    Key weights;
    for (std::size_t v = 0; v < n; ++v)
      if (const std::int8_t w = row.weights[point * n + v]; w != 0) weights.emplace_back(nodes[v], w);
    std::ranges::sort(weights);
    return weights;
  }

  std::vector<double>& coordinates_;
  std::map<Key, std::int32_t> known_;
};

/// The diagonal to draw in a cell: the shortest, the first of equal ones. @return its sub-cells; none where there is no choice
std::span<const catalog::SubCell> inside(const catalog::RefinementRow& row, std::span<const std::int32_t> nodes,
                                         std::span<const double> coordinates) {
  const auto d = static_cast<std::size_t>(catalog::cell(row.cell).dimension);
  const auto place = [&](int p) {
    return image(row.cell, nodes, row.points.subspan(static_cast<std::size_t>(p) * d, d), coordinates);
  };
  std::span<const catalog::SubCell> best;
  double least = std::numeric_limits<double>::infinity();
  for (const catalog::RefinementChoice& choice : row.choices) {
    const auto a = place(choice.first), b = place(choice.second);
    double length = 0;
    for (std::size_t k = 0; k < 3; ++k) length += (a[k] - b[k]) * (a[k] - b[k]);
    if (length < (1 - equal_lengths) * least) {
      least = length;
      best = choice.cells;
    }
  }
  return best;
}

}  // namespace

Mesh refine(const Mesh& mesh, std::span<const std::string> groups, std::string_view keyword, RefinementReport& report) {
  const std::string path(keyword);
  refuse_cut_mesh(mesh, path);
  report = {};
  const std::vector<char> mark = chosen(mesh, groups, path, report);

  Mesh done;
  done.name = mesh.name;
  done.dimension = mesh.dimension;
  done.coordinates = mesh.coordinates;
  done.node_groups = mesh.node_groups;

  // nodes first, and bodies before their facets, which may be linear under a curved body
  Points points(done.coordinates);
  std::vector<std::vector<catalog::SubCell>> sub_cells(mesh.n_cells());
  std::vector<Nodes> nodes(mesh.n_cells());
  const auto each_refined = [&](const auto& work) {
    for (int dimension = 3; dimension > 0; --dimension)
      for (std::size_t c = 0; c < mesh.n_cells(); ++c)
        if (mark[c] && mesh.row(c).dimension == dimension) work(c, *catalog::find_refinement(mesh.types[c]));
  };
  each_refined([&](std::size_t c, const catalog::RefinementRow& row) { points.enter(row, mesh.cells[c]); });
  each_refined([&](std::size_t c, const catalog::RefinementRow& row) {
    sub_cells[c].assign(row.cells.begin(), row.cells.end());
    const auto more = inside(row, mesh.cells[c], mesh.coordinates);
    sub_cells[c].insert(sub_cells[c].end(), more.begin(), more.end());
    std::vector<char> used(row.points.size() / static_cast<std::size_t>(mesh.row(c).dimension), 0);
    for (const catalog::SubCell& sub : sub_cells[c])
      for (const std::int8_t n : sub.nodes) used[static_cast<std::size_t>(n)] = 1;
    nodes[c] = points.of(row, mesh.cells[c], used);
  });

  Heirs heirs;
  for (std::size_t c = 0; c < mesh.n_cells(); ++c) {
    if (!mark[c]) done.add_cell(mesh.types[c], mesh.cells[c]);
    for (const catalog::SubCell& sub : sub_cells[c]) {
      const CellNodes cell_nodes = pick(nodes[c], sub.nodes);
      if (mesh.row(c).dimension == mesh.dimension && !is_sound(jacobian_range(sub.type, cell_nodes, done.coordinates)))
        fail("RAFFINE_2",
             {{"keyword", path}, {"cell", cell_name(static_cast<std::int64_t>(c))}, {"type", std::string(mesh.row(c).name)}});
      done.add_cell(sub.type, cell_nodes);
    }
    if (mark[c]) heirs.enter(static_cast<std::int32_t>(c), static_cast<std::int32_t>(sub_cells[c].size()));
  }
  done.cell_groups = mesh.cell_groups;
  heirs.inherit(done.cell_groups);

  std::vector<char> touched(mesh.n_nodes(), 0);
  for (std::size_t c = 0; c < mesh.n_cells(); ++c)
    if (mark[c])
      for (const std::int32_t n : mesh.cells[c]) touched[static_cast<std::size_t>(n)] = 1;
  for (const Group& group : mesh.node_groups)
    if (group.members.size() > 1 &&
        std::ranges::any_of(group.members, [&](std::int32_t n) { return touched[static_cast<std::size_t>(n)] != 0; }))
      report.node_groups.push_back(group.name);
  return done;
}

}  // namespace lacon
