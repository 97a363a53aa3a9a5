#include "lacon/operators/meshing/cut.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "lacon/catalog/cuts.hpp"
#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/operators/meshing/body.hpp"
#include "lacon/operators/meshing/cut_order.hpp"
#include "lacon/operators/meshing/quality.hpp"
#include "lacon/operators/meshing/skin.hpp"
#include "lacon/operators/meshing/subdivision.hpp"
#include "lacon/structures/vector.hpp"

namespace lacon {
namespace {

using Nodes = std::vector<std::int32_t>;

/// Cells while they are cut: a cell that was cut has the sub-cells that replace it. The first ones are those of the mesh; only
/// what changes is kept here.
class Forest {
 public:
  explicit Forest(const Mesh& mesh) : mesh_(mesh), n_cells_(mesh.n_cells()) {}

  CellType type(std::int32_t cell) const { return is_of_mesh(cell) ? mesh_.types[index(cell)] : types_[added(cell)]; }
  std::span<const std::int32_t> nodes(std::int32_t cell) const {
    if (!is_of_mesh(cell)) return std::as_const(nodes_)[added(cell)];
    const auto at = turned_.find(cell);
    return at == turned_.end() ? mesh_.cells[index(cell)] : std::span<const std::int32_t>(at->second);
  }
  void turn(std::int32_t cell) {
    Nodes nodes_now = mirrored(type(cell), nodes(cell));
    if (is_of_mesh(cell))
      turned_[cell] = std::move(nodes_now);
    else
      std::ranges::copy(nodes_now, nodes_[added(cell)].begin());
  }

  /// The sub-cells of a parent are added one behind the other. Spans of nodes do not outlive it.
  std::int32_t add(CellType type, const CellNodes& nodes, std::int32_t parent) {
    const auto cell = static_cast<std::int32_t>(size());
    types_.push_back(type);
    nodes_.push_back(nodes);
    children_.try_emplace(parent, Range{cell, cell}).first->second.end = cell + 1;
    return cell;
  }

  /// Visit what is left of a cell after all cuts so far, in order; stops where `visit` returns true, and says whether it did.
  template <class Visit>
  bool leaves(std::int32_t cell, const Visit& visit) const {
    const auto at = children_.find(cell);
    if (at == children_.end()) return visit(cell);
    for (std::int32_t child = at->second.first; child < at->second.end; ++child)
      if (leaves(child, visit)) return true;
    return false;
  }

  std::size_t size() const { return n_cells_ + types_.size(); }
  bool is_cut(std::int32_t cell) const { return children_.contains(cell); }
  /// The cells of the mesh that were cut, ascending.
  Nodes cut_cells() const {
    Nodes cells;
    for (const auto& [cell, children] : children_)
      if (is_of_mesh(cell)) cells.push_back(cell);
    std::ranges::sort(cells);
    return cells;
  }

 private:
  struct Range {
    std::int32_t first, end;
  };
  static std::size_t index(std::int32_t cell) { return static_cast<std::size_t>(cell); }
  bool is_of_mesh(std::int32_t cell) const { return index(cell) < n_cells_; }
  std::size_t added(std::int32_t cell) const { return index(cell) - n_cells_; }

  const Mesh& mesh_;
  std::size_t n_cells_;          ///< of the mesh before the cut
  std::vector<CellType> types_;  ///< of the cells that were added
  Ragged<std::int32_t> nodes_;
  std::unordered_map<std::int32_t, Nodes> turned_;    ///< cells of the mesh whose nodes have another order
  std::unordered_map<std::int32_t, Range> children_;  ///< of the cells that were cut
};

/// Append the images of reference points of a cell (isoparametric, METHOD.md 1.2-3) to the coordinates; returns their numbers.
CellNodes add_nodes(CellType type, const CellNodes& nodes, std::span<const double> points, std::vector<double>& coordinates) {
  const auto d = static_cast<std::size_t>(catalog::cell(type).dimension);
  CellNodes added;
  for (std::size_t p = 0; p < points.size() / d; ++p) {
    const auto point = image(type, nodes, points.subspan(p * d, d), coordinates);
    added.push_back(static_cast<std::int32_t>(coordinates.size() / 3));
    coordinates.insert(coordinates.end(), point.begin(), point.end());
  }
  return added;
}

void append(Nodes& to, std::span<const std::int32_t> more) { to.insert(to.end(), more.begin(), more.end()); }

void sort_once(Nodes& numbers) {
  std::ranges::sort(numbers);
  const auto twice = std::ranges::unique(numbers);
  numbers.erase(twice.begin(), twice.end());
}

Vec3 point_of(std::span<const double> coordinates, std::int32_t node) {
  return vector_at(coordinates.data() + 3 * static_cast<std::size_t>(node));
}

/// How far the mid node of an edge is from the middle of its vertices. @param edge of the cell's row
Vec3 bulge(const catalog::CellRow& row, std::size_t edge, std::span<const std::int32_t> nodes,
           std::span<const double> coordinates) {
  const Vec3 a = point_of(coordinates, nodes[static_cast<std::size_t>(row.edges[edge].first)]),
             b = point_of(coordinates, nodes[static_cast<std::size_t>(row.edges[edge].second)]),
             middle = point_of(coordinates, nodes[static_cast<std::size_t>(row.n_vertices) + edge]);
  return middle - 0.5 * (a + b);
}

/// A bulge below this fraction of the size of a facet or cell is round-off, also that of a file with seven or eight digits.
constexpr double flat = 1e-6;

/// Whether the mid nodes of a quadratic cell are on the straight lines between their vertices, up to `flat` of the longest
/// edge.
bool has_straight_edges(CellType type, std::span<const std::int32_t> nodes, std::span<const double> coordinates) {
  const catalog::CellRow& row = catalog::cell(type);
  double longest = 0, largest = 0;
  for (std::size_t e = 0; e < row.edges.size(); ++e) {
    const Vec3 a = point_of(coordinates, nodes[static_cast<std::size_t>(row.edges[e].first)]),
               b = point_of(coordinates, nodes[static_cast<std::size_t>(row.edges[e].second)]);
    const Vec3 d = b - a, off = bulge(row, e, nodes, coordinates);
    const double along = dot(off, d) / dot(d, d);
    if (!(std::abs(along) < 0.25)) return false;  // an edge that is folded, or without length
    longest = std::max(longest, norm(d));
    largest = std::max(largest, norm(off - along * d));
  }
  return largest <= flat * longest;
}

/// Whether the vertices of a facet lie in a plane, up to `flat` of its size.
bool is_plane(CellType type, const CellNodes& nodes, std::span<const double> coordinates) {
  const Vec3 origin = point_of(coordinates, nodes[0]);
  const auto from_origin = [&](std::size_t i) { return point_of(coordinates, nodes[i]) - origin; };
  const Vec3 normal = cross(from_origin(1), from_origin(2));
  const double area = norm(normal);
  for (std::size_t i = 3; i < static_cast<std::size_t>(catalog::cell(type).n_vertices); ++i)
    if (std::abs(dot(from_origin(i), normal)) > flat * std::sqrt(area) * area) return false;
  return true;
}

/// Put the new mid nodes of a sub-cell into the middle of their vertices. A cell with straight edges that is no parallelepiped
/// bends the straight lines of its reference cell: the isoparametric images would give its sub-cells curved edges, over which
/// no rule is exact, and its shape is the same without.
void straighten(CellType type, const CellNodes& sub_cell, const CellNodes& added, std::vector<double>& coordinates) {
  const catalog::CellRow& row = catalog::cell(type);
  for (std::size_t e = 0; e < row.edges.size(); ++e) {
    const std::int32_t middle = sub_cell[static_cast<std::size_t>(row.n_vertices) + e];
    if (std::ranges::find(added, middle) == added.end()) continue;
    const Vec3 shift = bulge(row, e, sub_cell, coordinates);
    double* const at = coordinates.data() + 3 * static_cast<std::size_t>(middle);
    at[0] -= shift.x, at[1] -= shift.y, at[2] -= shift.z;
  }
}

constexpr std::int64_t max_facets = 6;  ///< of a body cell

/// Every check on the groups and their cells, before anything is cut.
/// @param quality of the body cells under the skins
std::vector<Slave> find_slaves(const Mesh& mesh, std::span<const std::string> groups, const std::string& keyword,
                               std::vector<CellQuality>& quality) {
  const int skin_dimension = mesh.dimension - 1;
  Nodes near;  // the nodes at which body_cells() looks around
  for (const std::string& name : groups)
    if (const Group* group = mesh.find_cell_group(name))
      for (const std::int32_t cell : group->members) near.push_back(mesh.cells[static_cast<std::size_t>(cell)][0]);
  const NodeCells around(mesh, near, mesh.dimension);
  std::vector<Slave> slaves;
  std::unordered_map<std::int32_t, std::size_t> zone_of;    // of a slave cell
  std::unordered_map<std::int64_t, std::int32_t> slave_of;  // of a facet of a body cell
  zone_of.reserve(near.size());
  slave_of.reserve(near.size());
  for (std::size_t zone = 0; zone < groups.size(); ++zone) {
    const std::string& group = groups[zone];
    if (std::find(groups.begin(), groups.begin() + static_cast<std::ptrdiff_t>(zone), group) !=
        groups.begin() + static_cast<std::ptrdiff_t>(zone))
      fail("DECOUPE_1", {{"keyword", keyword}, {"group", group}});
    const auto members = cells_of_group(mesh, group, keyword);
    for (const std::int32_t cell : members) {
      const auto c = static_cast<std::size_t>(cell);
      if (mesh.row(c).dimension != skin_dimension)
        fail("DECOUPE_4", {{"keyword", keyword},
                           {"group", group},
                           {"cell", cell_name(cell)},
                           {"type", std::string(mesh.row(c).name)},
                           {"skin", skin_cells(mesh)}});
      if (const auto [at, fresh] = zone_of.emplace(cell, zone); !fresh)
        fail("DECOUPE_2", {{"keyword", keyword}, {"cell", cell_name(cell)}, {"first", groups[at->second]}, {"second", group}});
      const std::vector<BodyCell> bodies = body_cells(mesh, around, c);
      if (bodies.empty())
        fail("MESH1_2",
             {{"keyword", keyword}, {"group", group}, {"cell", cell_name(cell)}, {"type", std::string(mesh.row(c).name)}});
      refuse_inner(bodies, cell, keyword, group);
      const BodyCell& body = bodies[0];
      if (const auto [at, fresh] = slave_of.emplace(std::int64_t{body.cell} * max_facets + body.match.facet, cell); !fresh)
        fail("DECOUPE_5", {{"keyword", keyword},
                           {"group", group},
                           {"first", cell_name(at->second)},
                           {"second", cell_name(cell)},
                           {"body", cell_name(body.cell)}});
      const auto b = static_cast<std::size_t>(body.cell);
      if (!is_sound(jacobian_range(mesh.types[b], mesh.cells[b], mesh.coordinates)))
        fail("DECOUPE_6", {{"keyword", keyword},
                           {"group", group},
                           {"what", part("body_under_slave", {{"body", cell_name(body.cell)}, {"cell", cell_name(cell)}})},
                           {"type", std::string(mesh.row(b).name)}});
      slaves.push_back({cell, body.cell, zone});
      quality.emplace_back(scaled_jacobian(mesh.types[b], mesh.cells[b], mesh.coordinates), body.cell);  // while it is at hand
    }
    refuse_degenerate(mesh, members, std::string(keyword), group);
  }
  return slaves;
}

/// What became of a slave cell: its sub-cells by rank, as numbers of the forest, the patch's kind and the nodes that carry its
/// LAGS_C.
struct CutSlave {
  CellNodes sub_cells;
  std::int32_t kind = 0;
  CellNodes carriers;
};

/// Cut one slave cell and what its body cell has become. @param quality of the sub-cells of the body, by numbers of the forest
CutSlave cut_slave(Forest& forest, const Slave& slave, const std::string& group, std::string_view option,
                   const std::string& keyword, std::vector<double>& coordinates, CutZone& zone,
                   std::vector<CellQuality>& quality) {
  std::int32_t body = -1;
  FacetMatch match{};
  forest.leaves(slave.body, [&](std::int32_t leaf) {
    const auto found = match_facet(forest.type(leaf), forest.nodes(leaf), forest.type(slave.cell), forest.nodes(slave.cell));
    if (found) {
      body = leaf;
      match = *found;
    }
    return found.has_value();
  });
  if (body < 0) throw std::logic_error("a cut of " + cell_name(slave.body) + " has lost the facet of " + cell_name(slave.cell));

  const auto refuse = [&](const std::string& reason) {
    fail("CREALAC_1", {{"keyword", keyword},
                       {"group", group},
                       {"cell", cell_name(slave.cell)},
                       {"skin", std::string(catalog::cell(forest.type(slave.cell)).name)},
                       {"body_cell", cell_name(slave.body)},
                       {"body", std::string(catalog::cell(forest.type(body)).name)},
                       {"reason", reason}});
  };
  const catalog::CutRow* cut = catalog::find_cut(forest.type(slave.cell), forest.type(body), option);
  if (!cut) refuse(part("no_cut_for_pair"));
  if (!match.outward) {
    forest.turn(slave.cell);
    ++zone.turned;
    match = match_facet(forest.type(body), forest.nodes(body), forest.type(slave.cell), forest.nodes(slave.cell)).value();
  }

  // the body cell turned so that its facet lies where the row expects it
  const auto placement = std::ranges::find(cut->placements, match.facet, &catalog::Placement::facet);
  if (placement == cut->placements.end()) refuse(part("facet_of_other_type"));
  const CellNodes skin(forest.nodes(slave.cell));
  CellNodes turned_body = pick(forest.nodes(body), placement->nodes);
  const auto n_vertices = cut->facet.size();
  const std::int32_t first = turned_body[static_cast<std::size_t>(cut->facet[0])];
  const auto start = static_cast<std::size_t>(
      std::find(skin.begin(), skin.begin() + static_cast<std::ptrdiff_t>(n_vertices), first) - skin.begin());
  const catalog::FacetRow& facet = catalog::cell(forest.type(body)).facets[static_cast<std::size_t>(match.facet)];
  CellNodes of_facet = pick(forest.nodes(body), facet.nodes), of_skin = skin;
  std::ranges::sort(of_facet);
  std::ranges::sort(of_skin);
  if (!std::ranges::equal(of_facet, of_skin)) refuse(part("mid_nodes_differ"));

  const CellNodes new_skin = add_nodes(cut->skin, skin, cut->skin_nodes, coordinates);
  const CellNodes new_body = add_nodes(cut->body, turned_body, cut->body_nodes, coordinates);
  CellNodes on_skin = skin;
  on_skin.append(new_skin);
  turned_body.append(pick(new_skin, cut->turned.subspan(start * new_skin.size(), new_skin.size())));
  turned_body.append(new_body);
  append(zone.skin_nodes, new_skin);
  append(zone.body_nodes, new_body);
  if (catalog::cell(cut->skin).dimension == 2 && catalog::cell(cut->skin).order == 2) {
    if (has_straight_edges(cut->skin, skin, coordinates) && is_plane(cut->skin, skin, coordinates))
      for (const catalog::SubCell& sub : cut->skin_cells) straighten(sub.type, pick(on_skin, sub.nodes), new_skin, coordinates);
    if (has_straight_edges(cut->body, forest.nodes(body), coordinates))
      for (const catalog::SubCell& sub : cut->body_cells)
        straighten(sub.type, pick(turned_body, sub.nodes), new_body, coordinates);
  }

  CellNodes sub_cells;
  for (const catalog::SubCell& sub : cut->skin_cells)
    sub_cells.push_back(forest.add(sub.type, pick(on_skin, sub.nodes), slave.cell));
  for (const catalog::SubCell& sub : cut->body_cells) {
    const CellNodes own = pick(turned_body, sub.nodes);
    if (!is_sound(jacobian_range(sub.type, own, coordinates)))
      fail("DECOUPE_6",
           {{"keyword", keyword},
            {"group", group},
            {"what", part("sub_cell_under_slave", {{"body", cell_name(slave.body)}, {"cell", cell_name(slave.cell)}})},
            {"type", std::string(catalog::cell(sub.type).name)}});
    quality.emplace_back(scaled_jacobian(sub.type, own, coordinates), forest.add(sub.type, own, body));
  }
  ++zone.patches;
  return {sub_cells, cut->kind, pick(on_skin, cut->carriers)};
}

/// Put what a cell was cut into in its place. The mesh changes in place, back to front: what stays moves once.
/// @param number_of the numbers that the cells added to the forest get, -1 for those that were cut again
Heirs replace_cut_cells(Mesh& mesh, const Forest& forest, Nodes& number_of) {
  const Nodes cut = forest.cut_cells();
  const std::size_t n = mesh.n_cells();
  Heirs heirs;
  Ragged<std::int32_t> leaves;  // of each cut cell
  std::int64_t old_end = mesh.cells.offset.back(), end = old_end;
  Nodes own;
  for (const std::int32_t cell : cut) {
    own.clear();
    end -= static_cast<std::int64_t>(forest.nodes(cell).size());
    forest.leaves(cell, [&](std::int32_t leaf) {
      own.push_back(leaf);
      end += static_cast<std::int64_t>(forest.nodes(leaf).size());
      return false;
    });
    leaves.push_back(own);
    heirs.enter(cell, static_cast<std::int32_t>(own.size()));
  }
  number_of.assign(forest.size() - n, -1);
  // back to front: `end` and `next`, where the nodes and numbers of what comes behind begin, and old_end, where they began
  auto next = static_cast<std::size_t>(heirs.of(static_cast<std::int32_t>(n)).first);
  mesh.types.resize(next);
  mesh.cells.values.resize(static_cast<std::size_t>(end));
  std::vector<std::int64_t>& offset = mesh.cells.offset;
  offset.resize(next + 1);
  offset.back() = end;
  CellType* const types = mesh.types.data();
  std::int32_t* const values = mesh.cells.values.data();
  for (std::size_t k = cut.size(), last = n;; --k) {
    // the cells between a cut cell and the next, `last`; old numbers are at most the new ones, so nothing unread is overwritten
    const std::size_t start = k > 0 ? static_cast<std::size_t>(cut[k - 1]) + 1 : 0, count = last - start;
    const std::int64_t old_start = count > 0 ? offset[start] : old_end, shift = end - old_end;
    std::move_backward(types + start, types + last, types + next);
    std::move_backward(values + old_start, values + old_end, values + end);
    next -= count;
    for (std::size_t c = count; c-- > 0;) offset[next + c] = offset[start + c] + shift;
    old_end = old_start;
    end = old_start + shift;
    if (k == 0) return heirs;
    // the cut cell
    last = start - 1;
    old_end = offset[last];
    const auto of_cell = leaves[k - 1];
    for (std::size_t i = of_cell.size(); i-- > 0;) {
      const std::int32_t leaf = of_cell[i];
      const auto nodes = forest.nodes(leaf);
      end -= static_cast<std::int64_t>(nodes.size());
      --next;
      std::ranges::copy(nodes, values + end);
      types[next] = forest.type(leaf);
      offset[next] = end;
      number_of[static_cast<std::size_t>(leaf) - n] = static_cast<std::int32_t>(next);
    }
  }
}

}  // namespace

Mesh cut_lac(Mesh mesh, std::span<const std::string> groups, std::string_view option, std::string_view keyword,
             CutReport& report) {
  refuse_cut_mesh(mesh, keyword);
  const std::string path(keyword);
  std::vector<CellQuality> quality;
  const std::vector<Slave> slaves = find_slaves(mesh, groups, path, quality);

  report = {};
  for (const std::string& group : groups) report.zones.push_back({group});
  for (const Slave& slave : slaves) report.zones[slave.zone].bodies.push_back(slave.body);
  for (CutZone& zone : report.zones) {
    sort_once(zone.bodies);
    if (mesh.node_groups.empty()) continue;
    zone.old_skin_nodes = nodes_of_cells(mesh, mesh.find_cell_group(zone.group)->members);
    zone.old_body_nodes = nodes_of_cells(mesh, zone.bodies);
  }
  std::ranges::sort(quality, {}, &CellQuality::second);
  const auto twice = std::ranges::unique(quality, {}, &CellQuality::second);  // a body cell under several slave cells
  quality.erase(twice.begin(), twice.end());
  report.before = quality_of(quality);
  std::vector<CellQuality> of_sub_cells;

  const std::size_t n_nodes = mesh.n_nodes(), n_cells = mesh.n_cells();
  Patches patches;
  Forest forest(mesh);
  std::vector<CutSlave> made(slaves.size());
  for (const std::size_t k : order_of_cuts(mesh, slaves))
    made[k] = cut_slave(forest, slaves[k], groups[slaves[k].zone], option, path, mesh.coordinates, report.zones[slaves[k].zone],
                        of_sub_cells);

  Nodes number_of;
  const Heirs heirs = replace_cut_cells(mesh, forest, number_of);
  heirs.inherit(mesh.cell_groups);
  for (std::size_t p = 0; p < made.size(); ++p) {
    Nodes own;
    patches.kind.push_back(made[p].kind);
    patches.parent.push_back(slaves[p].cell);
    patches.carriers.push_back(made[p].carriers);
    for (const std::int32_t cell : made[p].sub_cells) own.push_back(number_of[static_cast<std::size_t>(cell) - n_cells]);
    patches.cells.push_back(own);
  }
  for (const CutZone& zone : report.zones) {
    patches.zone_group.push_back(zone.group);
    patches.zone_offset.push_back(patches.zone_offset.back() + zone.patches);
  }
  std::vector<CellQuality> after;
  for (const auto& [value, cell] : quality)
    if (!forest.is_cut(cell)) after.emplace_back(value, heirs.of(cell).first);
  for (const auto& [value, cell] : of_sub_cells)
    if (const std::int32_t number = number_of[static_cast<std::size_t>(cell) - n_cells]; number >= 0)
      after.emplace_back(value, number);
  report.after = quality_of(std::move(after));
  report.new_nodes = static_cast<std::int64_t>(mesh.n_nodes() - n_nodes);
  report.new_cells = static_cast<std::int64_t>(mesh.n_cells() - n_cells);
  mesh.patches = std::move(patches);
  return mesh;
}

namespace {

/// The new nodes of a zone that a group misses, where it holds all old ones.
Nodes missing_nodes(const CutZone& zone, const Group& group, std::size_t n_nodes) {
  std::vector<char> inside(n_nodes, 0);
  for (const std::int32_t node : group.members) inside[static_cast<std::size_t>(node)] = 1;
  const auto holds = [&](const Nodes& nodes) {
    return std::ranges::all_of(nodes, [&](std::int32_t node) { return inside[static_cast<std::size_t>(node)] != 0; });
  };
  Nodes fresh;
  if (holds(zone.old_skin_nodes)) append(fresh, zone.skin_nodes);
  if (!fresh.empty() && holds(zone.old_body_nodes)) append(fresh, zone.body_nodes);
  return fresh;
}

}  // namespace

void complete_node_groups(const CutReport& report, Mesh& cut) {
  for (Group& group : cut.node_groups)
    for (const CutZone& zone : report.zones) {
      const Nodes fresh = missing_nodes(zone, group, cut.n_nodes());
      if (fresh.empty()) continue;
      append(group.members, fresh);
      inform("DECOUPE_8", {{"group", group.name}, {"skin", zone.group}, {"count", std::to_string(fresh.size())}});
    }
}

void tell_node_groups(const CutReport& report, const Mesh& cut) {
  std::string names;
  for (const Group& group : cut.node_groups)
    if (std::ranges::any_of(report.zones,
                            [&](const CutZone& zone) { return !missing_nodes(zone, group, cut.n_nodes()).empty(); }))
      names += (names.empty() ? "'" : ", '") + group.name + "'";
  if (!names.empty()) inform("DECOUPE_11", {{"groups", names}});
}

}  // namespace lacon
