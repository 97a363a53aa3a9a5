#include "lacon/operators/meshing/conformity.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <tuple>

#include "lacon/operators/meshing/open_facets.hpp"
#include "lacon/structures/bodies.hpp"
#include "lacon/structures/vector.hpp"

namespace lacon {
namespace {

constexpr double near = 1e-4;  // from an edge or a face, in parts of its length: coordinates may come from single precision

Vec3 place(const Mesh& mesh, std::int32_t node) { return vector_at(mesh.point(static_cast<std::size_t>(node)).data()); }

std::span<const std::int8_t> vertices_of(const catalog::FacetRow& facet) {
  return facet.nodes.first(static_cast<std::size_t>(catalog::cell(facet.type).n_vertices));
}

std::vector<std::int32_t> vertices_of(const Mesh& mesh, const OpenFacet& facet) {
  const auto cell = static_cast<std::size_t>(facet.cell);
  std::vector<std::int32_t> nodes;
  for (const std::int8_t v : vertices_of(mesh.row(cell).facets[static_cast<std::size_t>(facet.facet)]))
    nodes.push_back(mesh.cells[cell][static_cast<std::size_t>(v)]);
  return nodes;
}

/// Quadrangles and triangles on the same nodes: no geometry is needed to know these.
Misfit diagonals(const Mesh& mesh, std::span<const OpenFacet> facets) {
  Misfit found;
  if (std::ranges::all_of(facets, [](const OpenFacet& f) { return f.n_vertices() == 4; })) return found;
  for (const OpenFacet& facet : facets) {
    if (facet.n_vertices() != 4) continue;
    for (std::size_t left_out = 0; left_out < 4; ++left_out) {
      std::array<std::int32_t, 4> corner = facet.vertices;
      std::copy(corner.begin() + static_cast<std::ptrdiff_t>(left_out) + 1, corner.end(),
                corner.begin() + static_cast<std::ptrdiff_t>(left_out));
      corner[3] = -1;
      const auto at = std::ranges::lower_bound(facets, corner, {}, &OpenFacet::vertices);
      if (at == facets.end() || at->vertices != corner) continue;
      if (found.count++ == 0) found = {.count = 1, .cell = facet.cell, .other = at->cell, .vertices = vertices_of(mesh, facet)};
      break;
    }
  }
  return found;
}

/// Without those on which a slave cell of the cut mesh lies: contact says how these fit what is opposite.
std::vector<OpenFacet> without_slaves(const Mesh& mesh, std::vector<OpenFacet> facets) {
  if (!mesh.patches) return facets;
  std::vector<std::array<std::int32_t, 4>> slaves;
  for (const std::int32_t cell : mesh.patches->cells.values) {
    const auto c = static_cast<std::size_t>(cell);
    slaves.push_back(distinct_vertices(mesh.cells[c].first(static_cast<std::size_t>(mesh.row(c).n_vertices))));
  }
  std::ranges::sort(slaves);
  std::erase_if(facets, [&](const OpenFacet& f) { return std::ranges::binary_search(slaves, f.vertices); });
  return facets;
}

struct Edge {
  std::int32_t first, last,  ///< vertices
      middle,                ///< -1 for a linear edge
      cell;
};

/// The edges of facets by their vertices.
class Edges {
 public:
  Edges(const Mesh& mesh, std::span<const OpenFacet> facets) : start_(mesh.n_nodes() + 1) {
    const auto each = [&](const auto& use) {
      for (const OpenFacet& open : facets) {
        const auto cell = static_cast<std::size_t>(open.cell);
        const catalog::FacetRow& facet = mesh.row(cell).facets[static_cast<std::size_t>(open.facet)];
        const catalog::CellRow& row = catalog::cell(facet.type);
        const auto node = [&](std::size_t i) { return mesh.cells[cell][static_cast<std::size_t>(facet.nodes[i])]; };
        for (std::size_t e = 0; e < row.edges.size(); ++e) {
          const std::int32_t a = node(static_cast<std::size_t>(row.edges[e].first)),
                             b = node(static_cast<std::size_t>(row.edges[e].second)),
                             middle = row.order == 2 ? node(static_cast<std::size_t>(row.n_vertices) + e) : -1;
          if (a == b) continue;  // of a cell drawn to a simpler one
          use({a, b, middle, open.cell});
          use({b, a, middle, open.cell});
        }
      }
    };
    each([&](const Edge& e) { ++start_[static_cast<std::size_t>(e.first) + 1]; });
    for (std::size_t n = 0; n + 1 < start_.size(); ++n) start_[n + 1] += start_[n];
    edges_.resize(static_cast<std::size_t>(start_.back()));
    end_.assign(start_.begin(), start_.end() - 1);
    each([&](const Edge& e) {
      const auto n = static_cast<std::size_t>(e.first);
      const auto before = (*this)[e.first];
      if (std::ranges::find(before, e.last, &Edge::last) == before.end()) edges_[static_cast<std::size_t>(end_[n]++)] = e;
    });
  }

  /// Those that leave a vertex, each once.
  std::span<const Edge> operator[](std::int32_t vertex) const {
    const auto n = static_cast<std::size_t>(vertex);
    return std::span(edges_).subspan(static_cast<std::size_t>(start_[n]), static_cast<std::size_t>(end_[n] - start_[n]));
  }
  bool join(std::int32_t a, std::int32_t b) const {
    const auto of_a = (*this)[a];
    return std::ranges::find(of_a, b, &Edge::last) != of_a.end();
  }

 private:
  std::vector<std::int32_t> start_, end_;  ///< of the edges of each vertex
  std::vector<Edge> edges_;
};

/// Where on an edge a node lies, 0 at its first vertex and 1 at its last; nothing for a node beside it.
std::optional<double> position(const Mesh& mesh, const Edge& edge, std::int32_t node) {
  const Vec3 start = place(mesh, edge.first), along = place(mesh, edge.last) - start, point = place(mesh, node) - start;
  const double square = dot(along, along);
  double t = dot(point, along) / square;
  Vec3 aside = point - t * along;
  if (edge.middle >= 0) {  // a parabola, whose parameter is not quite that of the chord
    const Vec3 bow = 4.0 * (place(mesh, edge.middle) - start) - 2.0 * along;
    const auto from_curve = [&] { return point - t * along - (t * (1 - t)) * bow; };
    for (int i = 0; i < 5; ++i) t += dot(from_curve(), along) / square;
    aside = from_curve();
  }
  return dot(aside, aside) <= near * near * square ? std::optional(t) : std::nullopt;
}

/// The first of the vertices that other edges are strung on from one end of an edge to the other; -1 where there are none.
std::int32_t strung_between(const Mesh& mesh, const Edges& edges, const Edge& edge) {
  std::int32_t first = -1, at = edge.first;
  for (double reached = 0;;) {
    std::int32_t next = -1;
    double nearest = 1 - near;
    for (const Edge& link : edges[at]) {
      const std::int32_t node = link.last;
      if (node == edge.last && at != edge.first) return first;
      if (node == edge.first || node == edge.last) continue;
      const auto t = position(mesh, edge, node);
      if (t && *t > reached + near && *t < nearest) nearest = *t, next = node;
    }
    if (next < 0) return -1;
    if (first < 0) first = next;
    reached = nearest;
    at = next;
  }
}

/// Whether a point lies in the inside of a triangle.
bool is_inside(Vec3 point, Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 normal = cross(b - a, c - a);
  const double square = dot(normal, normal), distance = dot(point - a, normal);  // times the norm, which is about length^2
  if (distance * distance > near * near * square * norm(normal)) return false;
  const auto weight = [&](Vec3 p, Vec3 q) { return dot(cross(p - point, q - point), normal) / square; };
  return weight(a, b) > near && weight(b, c) > near && weight(c, a) > near;
}

/// A vertex in the inside of a face from which edges lead to all vertices of the face; -1 where there is none.
std::int32_t middle_of(const Mesh& mesh, const Edges& edges, const OpenFacet& facet) {
  const auto corners = std::span(facet.vertices).first(facet.n_vertices());
  for (const Edge& link : edges[corners[0]]) {
    const std::int32_t node = link.last;
    const auto leads_to = [&](std::int32_t vertex) { return vertex != node && edges.join(node, vertex); };
    if (!std::ranges::all_of(corners, leads_to)) continue;
    const auto face = vertices_of(mesh, facet);
    const Vec3 point = place(mesh, node), a = place(mesh, face[0]), b = place(mesh, face[1]), c = place(mesh, face[2]);
    if (is_inside(point, a, b, c)) return node;
    if (face.size() == 3) continue;
    const Vec3 d = place(mesh, face[3]);
    const bool on_diagonal = norm(2.0 * point - a - c) <= near * norm(c - a);
    if (on_diagonal || is_inside(point, a, c, d)) return node;
  }
  return -1;
}

Misfit hanging(const Mesh& mesh, int dimension, std::span<const OpenFacet> facets) {
  Misfit found;
  const Edges edges(mesh, facets);
  for (std::int32_t vertex = 0; vertex < static_cast<std::int32_t>(mesh.n_nodes()); ++vertex)
    for (const Edge& edge : edges[vertex]) {
      if (edge.last < vertex) continue;  // the same backwards
      if (const std::int32_t node = strung_between(mesh, edges, edge); node >= 0 && found.count++ == 0)
        found = {.count = 1, .cell = edge.cell, .node = node, .vertices = {edge.first, edge.last}};
    }
  if (dimension == 2) return found;
  for (const OpenFacet& facet : facets)
    if (const std::int32_t node = middle_of(mesh, edges, facet); node >= 0 && found.count++ == 0)
      found = {.count = 1, .cell = facet.cell, .node = node, .vertices = vertices_of(mesh, facet)};
  return found;
}

/// One of the nodes at the place of each node of these facets, the same for all of them.
std::vector<std::int32_t> nodes_by_place(const Mesh& mesh, std::span<const OpenFacet> facets) {
  std::vector<std::int32_t> same(mesh.n_nodes(), -1);
  std::vector<std::pair<double, std::int32_t>> nodes;  // by their distance along an axis that no mesh is made along
  double size = 0;
  for (const OpenFacet& facet : facets) {
    const Vec3 corner = place(mesh, facet.vertices[0]);
    const double length = norm(place(mesh, facet.vertices[1]) - corner);
    if (size == 0 || length < size) size = length;
    for (const std::int32_t n : facet.vertices)
      if (n >= 0 && same[static_cast<std::size_t>(n)] < 0) {
        same[static_cast<std::size_t>(n)] = n;
        nodes.emplace_back(dot(place(mesh, n), {0.5416, 0.6181, 0.5698}), n);
      }
  }
  std::ranges::sort(nodes);
  const double reach = 1e-6 * size;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (std::size_t j = i; j-- > 0 && nodes[i].first - nodes[j].first <= reach;) {
      const auto [a, b] = std::pair(nodes[i].second, nodes[j].second);
      if (norm(place(mesh, a) - place(mesh, b)) > reach) continue;
      same[static_cast<std::size_t>(a)] = same[static_cast<std::size_t>(b)];
      break;
    }
  return same;
}

Misfit coincident(const Mesh& mesh, std::span<const OpenFacet> facets) {
  const std::vector<std::int32_t> same = nodes_by_place(mesh, facets);
  std::vector<std::pair<std::array<std::int32_t, 4>, std::size_t>> by_place;  // only facets whose place another one can have
  std::vector<char> shared(mesh.n_nodes());
  for (std::size_t n = 0; n < same.size(); ++n)
    if (same[n] >= 0 && same[n] != static_cast<std::int32_t>(n)) shared[n] = shared[static_cast<std::size_t>(same[n])] = 1;
  for (std::size_t f = 0; f < facets.size(); ++f) {
    std::array<std::int32_t, 4> vertices = facets[f].vertices;
    const std::size_t n = facets[f].n_vertices();
    const auto used = std::span(vertices).first(n);
    if (std::ranges::none_of(used, [&](std::int32_t node) { return shared[static_cast<std::size_t>(node)] != 0; })) continue;
    for (std::int32_t& node : used) node = same[static_cast<std::size_t>(node)];
    by_place.emplace_back(distinct_vertices(used), f);
  }
  std::ranges::sort(by_place);
  Misfit found;
  std::optional<Bodies> bodies;
  for (std::size_t i = 1; i < by_place.size(); ++i) {
    if (by_place[i].first != by_place[i - 1].first) continue;
    const OpenFacet &one = facets[by_place[i - 1].second], &other = facets[by_place[i].second];
    if (!bodies) bodies.emplace(mesh);
    if (bodies->of(one.vertices[0]) != bodies->of(other.vertices[0])) continue;
    if (found.count++ == 0) found = {.count = 1, .cell = one.cell, .other = other.cell, .vertices = vertices_of(mesh, one)};
  }
  return found;
}

}  // namespace

Misfit mixed_orders(const Mesh& mesh, int least_dimension, std::span<const char> counts) {
  /// Edges and quadrangular faces of a kind of cell. @param use(local vertices, has a node in its middle)
  const auto each = [&](const catalog::CellRow& row, const auto& use) {
    if (row.dimension < least_dimension) return;
    for (const auto& [first, second] : row.edges) use(std::array{first, second}, row.order == 2);
    if (row.dimension == 2 && row.n_vertices == 4) use(std::array<std::int8_t, 4>{0, 1, 2, 3}, row.n_nodes == 9);
    if (row.dimension == 3)
      for (const catalog::FacetRow& facet : row.facets)
        if (catalog::cell(facet.type).n_vertices == 4) use(facet.nodes.first(4), facet.nodes.size() == 9);
  };
  const auto used = [&](std::size_t cell) { return counts.empty() || counts[cell] != 0; };
  // without, with: most meshes have one of the two alone, and need no search
  std::array<bool, 2> edges{}, faces{};
  const auto kind = [&](const auto& vertices) -> std::array<bool, 2>& { return vertices.size() == 2 ? edges : faces; };
  for_each_run(mesh, [&](const catalog::CellRow& row, std::size_t first, std::size_t n_cells) {
    std::size_t c = first;
    while (c < first + n_cells && !used(c)) ++c;
    if (c < first + n_cells) each(row, [&](const auto& vertices, bool has_middle) { kind(vertices)[has_middle] = true; });
  });

  const auto mixed = [](const std::array<bool, 2>& has) { return has[0] && has[1]; };
  if (!mixed(edges) && !mixed(faces)) return {};

  struct Side {
    std::array<std::int32_t, 4> vertices;  ///< as distinct_vertices() has them
    bool has_middle;
    std::int32_t cell;
  };
  std::vector<Side> sides;
  for (std::size_t c = 0; c < mesh.n_cells(); ++c)
    if (used(c))
      each(mesh.row(c), [&](const auto& vertices, bool has_middle) {
        if (!mixed(kind(vertices))) return;
        std::array<std::int32_t, 4> nodes;
        std::size_t n = 0;
        for (const std::int8_t v : vertices) nodes[n++] = mesh.cells[c][static_cast<std::size_t>(v)];
        sides.push_back({distinct_vertices(std::span(nodes).first(n)), has_middle, static_cast<std::int32_t>(c)});
      });
  std::ranges::sort(sides, {}, [](const Side& s) { return std::tuple(s.vertices, s.has_middle, s.cell); });
  Misfit found;
  for (std::size_t i = 0, end = 0; i < sides.size(); i = end) {
    std::size_t with = i;
    while (end < sides.size() && sides[end].vertices == sides[i].vertices) with += !sides[end++].has_middle;
    if (sides[i].vertices[1] < 0 || with == i || with == end) continue;
    if (found.count++ > 0) continue;
    found = {.count = 1, .cell = sides[with].cell, .other = sides[i].cell, .vertices = {}};
    for (const std::int32_t node : sides[i].vertices)
      if (node >= 0) found.vertices.push_back(node);
  }
  return found;
}

Misfits misfits(const Mesh& mesh, int dimension, std::span<const char> counts) {
  Misfits all;
  all.middles = mixed_orders(mesh, dimension, counts);
  std::vector<OpenFacet> facets = open_facets(mesh, dimension, counts);
  if (dimension == 3) all.diagonals = diagonals(mesh, facets);
  facets = without_slaves(mesh, std::move(facets));
  all.hanging = hanging(mesh, dimension, facets);
  all.coincident = coincident(mesh, facets);
  return all;
}

}  // namespace lacon
