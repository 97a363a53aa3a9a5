#include "lacon/operators/meshing/skin.hpp"

#include <algorithm>
#include <cmath>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/operators/meshing/quality.hpp"
#include "lacon/pairing/pairing.hpp"
#include "lacon/structures/vector.hpp"

namespace lacon {

Side SkinSides::seen_from(std::span<const BodyCell> found) const {
  if (found.size() > 1) return Side::between;
  if (found.empty()) return Side::alone;
  const auto body = static_cast<std::size_t>(found[0].cell);
  const double volume = central_jacobian(mesh_.types[body], mesh_.cells[body], mesh_.coordinates);
  if (volume == 0) return Side::alone;
  return found[0].match.outward == (volume > 0) ? Side::outward : Side::inward;
}

namespace {

Vec3 vertex(const Mesh& mesh, std::int32_t node) {
  return vector_at(mesh.coordinates.data() + 3 * static_cast<std::size_t>(node));
}

/// The diagonal of the box around the nodes of some cells.
double extent_of(const Mesh& mesh, std::span<const std::int32_t> cells) {
  Vec3 least{INFINITY, INFINITY, INFINITY}, greatest = -1 * least;
  for (const std::int32_t cell : cells)
    for (const std::int32_t node : mesh.cells[static_cast<std::size_t>(cell)]) {
      const Vec3 x = vertex(mesh, node);
      least = {std::min(least.x, x.x), std::min(least.y, x.y), std::min(least.z, x.z)};
      greatest = {std::max(greatest.x, x.x), std::max(greatest.y, x.y), std::max(greatest.z, x.z)};
    }
  return norm(greatest - least);
}

constexpr double none = PairingTolerances().degenerate;  // what pairing would leave out is refused

/// @param extent of the skin
bool is_degenerate(const Mesh& mesh, std::span<const std::int32_t> vertices, double extent) {
  double longest = 0;
  for (const std::int32_t a : vertices)
    for (const std::int32_t b : vertices) longest = std::max(longest, norm(vertex(mesh, b) - vertex(mesh, a)));
  if (!(longest > none * extent)) return true;
  if (vertices.size() < 3) return false;
  const Vec3 origin = vertex(mesh, vertices[0]), across = vertex(mesh, vertices[2]) - origin,
             first = vertex(mesh, vertices[1]) - origin,
             other = vertices.size() > 3 ? vertex(mesh, vertices[3]) - vertex(mesh, vertices[1]) : -1 * first;
  return !(norm(cross(across, other)) > none * longest * longest);
}

}  // namespace

std::string skin_cells(const Mesh& mesh) {
  if (mesh.dimension == 2) return part("segments");
  const bool is_solid = std::ranges::any_of(mesh.types, [](CellType type) { return catalog::cell(type).dimension == 3; });
  return part(is_solid ? "faces" : "faces_of_solids");
}

void refuse_degenerate(const Mesh& mesh, std::span<const std::int32_t> cells, const std::string& keyword,
                       const std::string& group) {
  const double extent = extent_of(mesh, cells);
  for (const std::int32_t cell : cells) {
    const auto c = static_cast<std::size_t>(cell);
    const auto vertices = mesh.cells[c].first(static_cast<std::size_t>(mesh.row(c).n_vertices));
    if (!is_degenerate(mesh, vertices, extent)) continue;
    std::string nodes;
    for (const std::int32_t node : vertices) nodes += (nodes.empty() ? "" : ", ") + node_name(node);
    fail("SKIN_1", {{"keyword", keyword},
                    {"type", std::string(mesh.row(c).name)},
                    {"cell", cell_name(cell)},
                    {"group", group},
                    {"what", part(vertices.size() < 3 ? "skin_without_length" : "skin_without_area")},
                    {"nodes", nodes}});
  }
}

}  // namespace lacon
