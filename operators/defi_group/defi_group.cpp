#include "lacon/operators/defi_group/defi_group.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/operators/meshing/chain.hpp"
#include "lacon/structures/names.hpp"
#include "lacon/structures/vector.hpp"

namespace lacon {
namespace {

using Members = std::vector<std::int32_t>;

/// What differs between groups of cells and of nodes.
struct Kind {
  std::string_view name;    ///< "cell"
  char letter;              ///< of M12, N3
  std::string_view remove;  ///< the keyword that removes such a group
  std::vector<Group> Mesh::*groups;
  std::span<const std::int32_t> (*members)(const Mesh&, std::string_view, std::string_view);
};

const Kind cells{"cell", 'M', "DETR_GROUP_MA", &Mesh::cell_groups, cells_of_group};
const Kind nodes{"node", 'N', "DETR_GROUP_NO", &Mesh::node_groups, nodes_of_group};

/// A value that is none (KEYWORD_18). @param expected a part
[[noreturn]] void refuse(const Keywords& factor, std::string_view keyword, std::string_view expected,
                         std::initializer_list<MessageValue> values = {}) {
  fail("KEYWORD_18", {{"keyword", factor.path(keyword)}, {"expected", part(expected, values)}});
}

/// The number behind `M12`, 0-based.
std::int32_t number_of(const Mesh& mesh, std::string_view name, const Kind& kind, std::size_t count,
                       const std::string& keyword) {
  const std::optional<std::int32_t> number = find_by_name(mesh, name, kind.letter == 'N' ? Entity::node : Entity::cell);
  if (!number)
    fail("GROUPE_2", {{"keyword", keyword},
                      {"what", part(kind.name)},
                      {"name", std::string(name)},
                      {"first", std::string(1, kind.letter) + "1"},
                      {"last", std::string(1, kind.letter) + std::to_string(count)}});
  return *number;
}

/// Each member once, in the order of its first appearance.
Members once(const Members& members, std::size_t count) {
  std::vector<char> seen(count, 0);
  Members kept;
  for (const std::int32_t m : members)
    if (!std::exchange(seen[static_cast<std::size_t>(m)], 1)) kept.push_back(m);
  return kept;
}

/// NOM of members by name, UNION, INTERSEC or DIFFE of groups: nothing where the occurrence has none of them.
std::optional<Members> combined(const Mesh& mesh, const Kind& kind, const Keywords& factor, std::size_t count) {
  const auto group = [&](const std::string& name, const char* keyword) {
    const auto own = kind.members(mesh, name, factor.path(keyword));
    return Members(own.begin(), own.end());
  };
  for (const char* keyword : {"UNION", "INTERSEC", "DIFFE"}) {
    const std::vector<std::string> names = factor.texts(keyword);
    if (names.empty()) continue;
    Members members = group(names[0], keyword);
    for (std::size_t i = 1; i < names.size(); ++i) {
      const Members other = group(names[i], keyword);
      if (keyword == std::string_view("UNION")) {
        members.insert(members.end(), other.begin(), other.end());
        continue;
      }
      std::vector<char> in_other(count, 0);
      for (const std::int32_t m : other) in_other[static_cast<std::size_t>(m)] = 1;
      const bool keep = keyword == std::string_view("INTERSEC");
      std::erase_if(members, [&](std::int32_t m) { return (in_other[static_cast<std::size_t>(m)] != 0) != keep; });
    }
    return members;
  }
  const char* by_name = kind.letter == 'M' ? "MAILLE" : "NOEUD";
  const char* copy = kind.letter == 'M' ? "GROUP_MA" : "GROUP_NO";
  if (factor.has(by_name)) {
    Members members;
    for (const std::string& name : factor.texts(by_name))
      members.push_back(number_of(mesh, name, kind, count, factor.path(by_name)));
    return members;
  }
  if (factor.has(copy)) return group(factor.text(copy), copy);
  return std::nullopt;
}

void refuse_existing(const Mesh& mesh, const Kind& kind, const std::string& name, const std::string& keyword) {
  for (const Group& group : mesh.*kind.groups)
    if (group.name == name)
      fail("GROUPE_1",
           {{"keyword", keyword}, {"what", part(kind.name)}, {"group", name}, {"remove", std::string(kind.remove)}});
}

void add_group(Mesh& mesh, const Kind& kind, const std::string& name, const Members& members, const std::string& keyword,
               bool alarm) {
  refuse_existing(mesh, kind, name, keyword);
  if (members.empty()) {
    if (alarm) inform("GROUPE_3", {{"keyword", keyword}, {"what", part(kind.name)}, {"group", name}});
    return;
  }
  const bool of_nodes = kind.name == std::string_view("node");
  fmt::print("  {} {:<24} {:>8} {}\n", part(of_nodes ? "node_group" : "cell_group"), name, members.size(),
             part(of_nodes ? "nodes" : "cells"));
  (mesh.*kind.groups).push_back({name, members});
}

void remove_groups(Mesh& mesh, const Kind& kind, const Keywords& keywords) {
  for (const Keywords& factor : keywords.factors(kind.remove))
    for (const std::string& name : factor.texts("NOM")) {
      if (std::none_of((mesh.*kind.groups).begin(), (mesh.*kind.groups).end(), [&](const Group& g) { return g.name == name; }))
        kind.members(mesh, name, factor.path("NOM"));  // throws MESH_1
      std::erase_if(mesh.*kind.groups, [&](const Group& group) { return group.name == name; });
    }
}

/// Only cells of the types that TYPE_MAILLE names.
void keep_types(const Mesh& mesh, const Keywords& factor, Members& members) {
  std::vector<char> wanted(catalog::cells().size(), 0);
  for (const std::string& name : factor.texts("TYPE_MAILLE")) {
    const auto type = catalog::find_cell(name);
    const bool by_dimension = name == "1D" || name == "2D" || name == "3D";
    if (!type && !by_dimension && name != "TOUT") fail("GROUPE_5", {{"keyword", factor.path("TYPE_MAILLE")}, {"name", name}});
    for (const catalog::CellRow& row : catalog::cells())
      if (name == "TOUT" || row.type == type || (by_dimension && row.dimension == name[0] - '0'))
        wanted[static_cast<std::size_t>(row.type)] = 1;
  }
  if (factor.has("TYPE_MAILLE"))
    std::erase_if(members,
                  [&](std::int32_t c) { return !wanted[static_cast<std::size_t>(mesh.types[static_cast<std::size_t>(c)])]; });
}

/// POSITION, NUME_INIT and NUME_FIN: a part of the members, in their order.
void keep_positions(const Keywords& factor, Members& members) {
  const auto n = static_cast<std::int64_t>(members.size());
  std::int64_t first = factor.has("NUME_INIT") ? factor.integer("NUME_INIT") : 1;
  std::int64_t last = factor.has("NUME_FIN") ? factor.integer("NUME_FIN") : n;
  if (factor.has("POSITION")) {
    const std::string position = factor.text("POSITION");
    first = last = position == "INIT" ? 1 : position == "FIN" ? n : (n + 1) / 2;
  }
  if (first > last || last > n) {
    const char* keyword = last > n ? "NUME_FIN" : "NUME_INIT";
    refuse(factor, keyword, "number_of_a_member", {{"count", std::to_string(n)}});
  }
  members = Members(members.begin() + (first - 1), members.begin() + last);
}

/// VECT_NORMALE with length 1.
Vec3 direction_of(const Mesh& mesh, const Keywords& factor) {
  const Vec3 direction = factor.vector("VECT_NORMALE", mesh.dimension);
  const double length = norm(direction);
  if (!(length > 0)) refuse(factor, "VECT_NORMALE", "a_direction");
  return direction / length;
}

/// Distance from what POINT and VECT_NORMALE describe: a plane, an axis, or a centre.
class Distance {
 public:
  enum class From { plane, axis, centre };

  Distance(const Mesh& mesh, const Keywords& factor, From from) : from_(from), point_(factor.vector("POINT", mesh.dimension)) {
    if (from != From::centre) direction_ = direction_of(mesh, factor);
  }

  double operator()(std::span<const double, 3> x) const {
    const Vec3 to = vector_at(x.data()) - point_;
    const double height = dot(to, direction_);
    if (from_ == From::plane) return std::abs(height);
    const Vec3 off = to - height * direction_;
    return std::hypot(off.x, off.y, off.z);
  }

 private:
  From from_;
  Vec3 point_, direction_{};
};

Distance::From kind_of_place(const std::string& option) {
  if (option.ends_with("SPHERE")) return Distance::From::centre;
  return option.ends_with("CYLINDRE") ? Distance::From::axis : Distance::From::plane;
}

/// The cells of which enough nodes are marked. @param rule AU_MOINS_UN, TOUS or TOUT, MAJORITE, SOMMET (all vertices)
Members cells_with(const Mesh& mesh, const std::vector<char>& marked, const std::string& rule) {
  Members found;
  for (std::size_t c = 0; c < mesh.n_cells(); ++c) {
    auto own = mesh.cells[c];
    if (rule == "SOMMET") own = own.first(static_cast<std::size_t>(mesh.row(c).n_vertices));
    const auto inside = static_cast<std::size_t>(
        std::ranges::count_if(own, [&](std::int32_t n) { return marked[static_cast<std::size_t>(n)] != 0; }));
    if (rule == "AU_MOINS_UN" ? inside > 0 : rule == "MAJORITE" ? 2 * inside >= own.size() : inside == own.size())
      found.push_back(static_cast<std::int32_t>(c));
  }
  return found;
}

/// The mean normal of a skin cell by its vertices, as long as its measure; 0 for another cell.
Vec3 normal_of(const Mesh& mesh, std::size_t cell) {
  const catalog::CellRow& row = mesh.row(cell);
  if (row.dimension != mesh.dimension - 1) return {};
  const auto corners = mesh.cells[cell].first(static_cast<std::size_t>(row.n_vertices));
  const auto place = [&](std::size_t k) {
    return vector_at(mesh.point(static_cast<std::size_t>(corners[k % corners.size()])).data());
  };
  if (row.dimension == 1) {
    const Vec3 along = place(1) - place(0);
    return {along.y, -along.x, 0};
  }
  Vec3 normal{};
  for (std::size_t k = 0; k < corners.size(); ++k) normal = normal + 0.5 * cross(place(k), place(k + 1));
  return normal;
}

/// FACE_NORMALE: skin cells whose normal is within ANGL_PREC of VECT_NORMALE, or with VERI_SIGNE='NON' of its line.
Members cells_that_face(const Mesh& mesh, const Keywords& factor) {
  const Vec3 direction = direction_of(mesh, factor);
  const double most = factor.real("ANGL_PREC") * std::numbers::pi / 180;
  const bool with_sign = factor.yes("VERI_SIGNE");
  Members found;
  for (std::size_t c = 0; c < mesh.n_cells(); ++c) {
    const Vec3 normal = normal_of(mesh, c);
    if (!(norm(normal) > 0)) continue;
    const double along = dot(normal, direction), across = norm(normal - along * direction);
    if (std::atan2(across, with_sign ? along : std::abs(along)) <= most) found.push_back(static_cast<std::int32_t>(c));
  }
  return found;
}

Members cells_by_option(const Mesh& mesh, const Keywords& factor) {
  const std::string option = factor.text("OPTION");
  if (option == "FACE_NORMALE") return cells_that_face(mesh, factor);
  std::vector<char> marked(mesh.n_nodes(), 0);
  if (option == "APPUI") {
    for (const std::string& group : factor.texts("GROUP_NO"))
      for (const std::int32_t n : nodes_of_group(mesh, group, factor.path("GROUP_NO"))) marked[static_cast<std::size_t>(n)] = 1;
    return cells_with(mesh, marked, factor.text("TYPE_APPUI"));
  }
  const Distance distance(mesh, factor, kind_of_place(option));
  const double most = factor.real(option == "BANDE" ? "DIST" : "RAYON");
  for (std::size_t n = 0; n < mesh.n_nodes(); ++n) marked[n] = distance(mesh.point(n)) <= most;
  return cells_with(mesh, marked, factor.has("CRIT_NOEUD") ? factor.text("CRIT_NOEUD") : "AU_MOINS_UN");
}

Vec3 step(const Mesh& mesh, std::int32_t from, std::int32_t to) {
  return vector_at(mesh.point(static_cast<std::size_t>(to)).data()) -
         vector_at(mesh.point(static_cast<std::size_t>(from)).data());
}

/// The node at an end of a line: GROUP_NO_ORIG or NOEUD_ORIG for the suffix ORIG, or none.
std::optional<std::int32_t> end_node(const Mesh& mesh, const Keywords& factor, const std::string& suffix) {
  if (const std::string keyword = "NOEUD_" + suffix; factor.has(keyword))
    return number_of(mesh, factor.text(keyword), nodes, mesh.n_nodes(), factor.path(keyword));
  const std::string keyword = "GROUP_NO_" + suffix;
  if (!factor.has(keyword)) return std::nullopt;
  const auto members = nodes_of_group(mesh, factor.text(keyword), factor.path(keyword));
  if (members.size() != 1) refuse(factor, keyword, "group_of_one_node");
  return members.front();
}

/// NOEUD_ORDO: the nodes of line cells in their order, from ORIG; a closed line goes along VECT_ORIE.
Members nodes_along_cells(const Mesh& mesh, const Keywords& factor) {
  if (factor.texts("GROUP_MA").size() != 1) refuse(factor, "GROUP_MA", "one_group_of_cells");
  const std::string group = factor.texts("GROUP_MA").front();
  Members line = chain_of_lines(mesh, group, factor.path("GROUP_MA"));
  const std::optional<std::int32_t> first = end_node(mesh, factor, "ORIG"), last = end_node(mesh, factor, "EXTR");
  const bool closed = line.front() == line.back();
  if (closed) {
    line.pop_back();
    const auto at = std::ranges::find(line, first.value_or(line.front()));
    std::ranges::rotate(line, at == line.end() ? line.begin() : at);
    std::vector<double> leaving = factor.reals("VECT_ORIE");
    leaving.resize(3, 0.0);  // none, or one of the plane, is given
    if (dot(vector_at(leaving.data()), step(mesh, line[0], line[1])) < 0) std::reverse(line.begin() + 1, line.end());
  } else if ((first && *first == line.back()) || (last && *last == line.front())) {
    std::ranges::reverse(line);
  }
  for (const auto& [node, suffix, end] :
       {std::tuple(first, "ORIG", line.front()), {last, "EXTR", closed ? line.front() : line.back()}})
    if (node && *node != end)
      fail("GROUPE_7", {{"keyword", factor.path((factor.has(std::string("NOEUD_") + suffix) ? "NOEUD_" : "GROUP_NO_") +
                                                std::string(suffix))},
                        {"node", node_name(*node)},
                        {"group", group},
                        {"first", node_name(line.front())},
                        {"last", node_name(line.back())}});
  return line;
}

/// SEGM_DROI_ORDO: nodes on the segment from ORIG to EXTR in their order.
Members nodes_along_segment(const Mesh& mesh, const Keywords& factor) {
  Members members;
  for (const std::string& group : factor.texts("GROUP_MA"))
    std::ranges::copy(nodes_of_cells(mesh, cells_of_group(mesh, group, factor.path("GROUP_MA"))), std::back_inserter(members));
  if (const auto named = factor.has("GROUP_MA") ? std::nullopt : combined(mesh, nodes, factor, mesh.n_nodes()))
    members = *named;
  const std::optional<std::int32_t> first = end_node(mesh, factor, "ORIG"), last = end_node(mesh, factor, "EXTR");
  for (const auto& [node, suffix] : {std::pair(first, "ORIG"), {last, "EXTR"}})
    if (!node) refuse(factor, std::string("GROUP_NO_") + suffix, "group_of_one_node");
  const Vec3 whole = step(mesh, *first, *last);
  const double length = norm(whole);
  if (!(length > 0)) refuse(factor, factor.has("NOEUD_EXTR") ? "NOEUD_EXTR" : "GROUP_NO_EXTR", "another_place_than_orig");
  const double allowed = factor.real("PRECISION") * (factor.text("CRITERE") == "RELATIF" ? length : 1.0);
  std::vector<std::pair<double, std::int32_t>> places;
  double worst = 0;
  std::int32_t worst_node = -1, away = 0;
  for (const std::int32_t node : members) {
    const Vec3 to = step(mesh, *first, node);
    const double along = dot(to, whole) / length, nearest = std::clamp(along, 0.0, length);
    const double distance = norm(to - nearest * whole / length);
    away += distance > allowed;
    if (distance > allowed && distance > worst) worst = distance, worst_node = node;
    places.emplace_back(along, node);
  }
  if (away > 0)
    fail("GROUPE_8", {{"keyword", factor.path("PRECISION")},
                      {"count", std::to_string(away)},
                      {"first", node_name(*first)},
                      {"last", node_name(*last)},
                      {"allowed", fmt::format("{:g}", allowed)},
                      {"node", node_name(worst_node)},
                      {"distance", fmt::format("{:g}", worst)}});
  std::ranges::stable_sort(places, {}, &std::pair<double, std::int32_t>::first);
  std::ranges::transform(places, members.begin(), &std::pair<double, std::int32_t>::second);
  return members;
}

Members nodes_by_option(const Mesh& mesh, const Keywords& factor) {
  const std::string option = factor.text("OPTION");
  if (option == "NOEUD_ORDO") return nodes_along_cells(mesh, factor);
  if (option == "SEGM_DROI_ORDO") return nodes_along_segment(mesh, factor);
  const Distance distance(mesh, factor, kind_of_place(option));
  const double radius = option == "PLAN" ? 0.0 : factor.real("RAYON"), precision = factor.real("PRECISION");
  Members found;
  for (std::size_t n = 0; n < mesh.n_nodes(); ++n)
    if (std::abs(distance(mesh.point(n)) - radius) <= precision) found.push_back(static_cast<std::int32_t>(n));
  return found;
}

void create_cell_group(Mesh& mesh, const Keywords& factor, bool alarm) {
  Members members;
  if (const auto found = combined(mesh, cells, factor, mesh.n_cells())) {
    members = *found;
  } else if (factor.has("TOUT")) {
    members.resize(mesh.n_cells());
    std::iota(members.begin(), members.end(), 0);
  } else if (factor.has("OPTION")) {
    members = cells_by_option(mesh, factor);
  } else {
    fail("ORDER_2", {{"keyword", factor.path("TOUT, MAILLE, GROUP_MA, INTERSEC, UNION, DIFFE or OPTION")}});
  }
  if (factor.has("GROUP_MA")) keep_positions(factor, members);
  keep_types(mesh, factor, members);
  add_group(mesh, cells, factor.text("NOM"), once(members, mesh.n_cells()), factor.path("NOM"), alarm);
}

/// The nodes of cells, in the mesh's order. @param which TOUS, or their SOMMETs, the MILIEUs of edges, the CENTREs of faces and
/// cells
Members nodes_of_cells(const Mesh& mesh, std::span<const std::int32_t> members, const std::string& which) {
  if (which == "TOUS") return nodes_of_cells(mesh, members);
  std::vector<char> found(mesh.n_nodes(), 0);
  for (const std::int32_t c : members) {
    const catalog::CellRow& row = mesh.row(static_cast<std::size_t>(c));
    const int edges = static_cast<int>(row.edges.size());
    const int middles = row.n_vertices, centres = std::min(row.n_nodes, middles + edges);
    const auto [first, end] = which == "SOMMET"   ? std::pair(0, middles)
                              : which == "MILIEU" ? std::pair(middles, centres)
                                                  : std::pair(centres, row.n_nodes);
    for (int i = first; i < end; ++i)
      found[static_cast<std::size_t>(mesh.cells[static_cast<std::size_t>(c)][static_cast<std::size_t>(i)])] = 1;
  }
  Members kept;
  for (std::size_t n = 0; n < found.size(); ++n)
    if (found[n]) kept.push_back(static_cast<std::int32_t>(n));
  return kept;
}

/// The one name that a group takes which is not the nodes of a group of cells.
std::string only_name(const Keywords& factor) {
  const std::vector<std::string> names = factor.texts("NOM");
  if (names.size() != 1) refuse(factor, "NOM", "one_name");
  return names.front();
}

void create_node_group(Mesh& mesh, const Keywords& factor, bool alarm) {
  if (factor.has("TOUT_GROUP_MA")) {
    for (const Group& group : std::vector<Group>(mesh.cell_groups)) {
      if (mesh.find_node_group(group.name))
        inform("GROUPE_6", {{"keyword", factor.path("TOUT_GROUP_MA")}, {"group", group.name}});
      else
        add_group(mesh, nodes, group.name, nodes_of_cells(mesh, group.members), factor.path("TOUT_GROUP_MA"), alarm);
    }
    return;
  }
  if (factor.has("GROUP_MA") && !factor.has("OPTION")) {
    const std::vector<std::string> groups = factor.texts("GROUP_MA"), names = factor.has("NOM") ? factor.texts("NOM") : groups;
    if (names.size() != groups.size())
      fail(
          "GROUPE_4",
          {{"keyword", factor.path("NOM")}, {"names", std::to_string(names.size())}, {"count", std::to_string(groups.size())}});
    for (std::size_t g = 0; g < groups.size(); ++g)
      add_group(mesh, nodes, names[g],
                nodes_of_cells(mesh, cells_of_group(mesh, groups[g], factor.path("GROUP_MA")),
                               factor.has("CRIT_NOEUD") ? factor.text("CRIT_NOEUD") : "TOUS"),
                factor.path(factor.has("NOM") ? "NOM" : "GROUP_MA"), alarm);
    return;
  }
  std::optional<Members> found =
      factor.has("OPTION") ? nodes_by_option(mesh, factor) : combined(mesh, nodes, factor, mesh.n_nodes());
  if (!found)
    fail("ORDER_2", {{"keyword", factor.path("TOUT_GROUP_MA, GROUP_MA, NOEUD, GROUP_NO, INTERSEC, UNION, DIFFE or OPTION")}});
  if (factor.has("GROUP_NO") && !factor.has("OPTION")) keep_positions(factor, *found);
  add_group(mesh, nodes, only_name(factor), once(*found, mesh.n_nodes()), factor.path("NOM"), alarm);
}

}  // namespace

void defi_group(Mesh& mesh, const Keywords& keywords) {
  const bool alarm = keywords.yes("ALARME");
  remove_groups(mesh, cells, keywords);
  remove_groups(mesh, nodes, keywords);
  for (const Keywords& factor : keywords.factors("CREA_GROUP_MA")) create_cell_group(mesh, factor, alarm);
  for (const Keywords& factor : keywords.factors("CREA_GROUP_NO")) create_node_group(mesh, factor, alarm);
}

}  // namespace lacon
