#include "lacon/operators/modi_maillage/transform.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include "lacon/catalog/cells.hpp"
#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/operators/meshing/body.hpp"
#include "lacon/operators/meshing/patch_turn.hpp"
#include "lacon/structures/vector.hpp"

namespace lacon {
namespace {

[[noreturn]] void refuse(const Keywords& keywords, const char* keyword, const char* expected) {
  fail("KEYWORD_18", {{"keyword", keywords.path(keyword)}, {"expected", part(expected)}});
}

Vec3 unit(const Keywords& keywords, const char* keyword, Vec3 given) {
  const double length = norm(given);
  if (!(length > 0)) refuse(keywords, keyword, "a_direction");
  return given / length;
}

template <class Move>
void each_node(Mesh& mesh, const Move& move) {
  for (std::size_t n = 0; n < mesh.n_nodes(); ++n) {
    double* const at = mesh.coordinates.data() + 3 * n;
    const Vec3 moved = move(vector_at(at));
    at[0] = moved.x, at[1] = moved.y, at[2] = moved.z;
  }
}

/// Rodrigues' formula about the axis through `from`.
void rotate(Mesh& mesh, const Keywords& factor) {
  const Vec3 from = factor.vector("POIN_1", mesh.dimension);
  Vec3 axis{0, 0, 1};
  if (mesh.dimension == 3) {
    const char* keyword = factor.has("POIN_2") ? "POIN_2" : "DIR";
    if (!factor.has(keyword)) refuse(factor, "DIR", "given_or_second_point");
    axis = factor.vector(keyword, mesh.dimension);
    if (factor.has("POIN_2")) axis = axis - from;
    axis = unit(factor, keyword, axis);
  }
  const double angle = factor.real("ANGLE") * std::numbers::pi / 180, c = std::cos(angle), s = std::sin(angle);
  each_node(mesh, [&](Vec3 x) {
    const Vec3 r = x - from;
    return from + c * r + s * cross(axis, r) + (dot(axis, r) * (1 - c)) * axis;
  });
}

void mirror(Mesh& mesh, const Keywords& factor) {
  const Vec3 point = factor.vector("POINT", mesh.dimension), first = factor.vector("AXE_1", mesh.dimension);
  Vec3 second{0, 0, 1};
  if (mesh.dimension == 3) {
    if (!factor.has("AXE_2")) refuse(factor, "AXE_2", "given_in_space");
    second = factor.vector("AXE_2", mesh.dimension);
  }
  const Vec3 normal = unit(factor, "AXE_1", cross(first, second));
  each_node(mesh, [&](Vec3 x) { return x - (2 * dot(normal, x - point)) * normal; });
  for (std::size_t c = 0; c < mesh.n_cells(); ++c)
    std::ranges::copy(mirrored(mesh.types[c], mesh.cells[c]), mesh.cells[c].begin());
  if (!mesh.patches) return;
  std::vector<std::int32_t> patches(mesh.patches->size());
  std::iota(patches.begin(), patches.end(), 0);
  settle_turned(mesh, patches);
}

double largest(const Mesh& mesh) {
  double most = 0;
  for (const double coordinate : mesh.coordinates) most = std::max(most, std::abs(coordinate));
  return most;
}

/// Whether vectors have three numbers: a mesh of the plane that is moved so is one in space, as long as it is not in the plane.
bool asks_for_space(const Keywords& keywords) {
  if (keywords.has("TRANSLATION")) return keywords.reals("TRANSLATION").size() == 3;
  for (const auto& [factor, point] : {std::pair{"ROTATION", "POIN_1"}, std::pair{"SYMETRIE", "POINT"}})
    for (const Keywords& one : keywords.factors(factor))
      if (one.reals(point).size() == 3) return true;
  return false;
}

bool move(Mesh& mesh, const Keywords& keywords) {
  if (keywords.has("TRANSLATION")) {
    const Vec3 by = keywords.vector("TRANSLATION", mesh.dimension);
    each_node(mesh, [&](Vec3 x) { return x + by; });
    return true;
  }
  if (keywords.has("ECHELLE")) {
    const double scale = keywords.real("ECHELLE");
    each_node(mesh, [&](Vec3 x) { return scale * x; });
    return true;
  }
  for (const Keywords& factor : keywords.factors("ROTATION")) rotate(mesh, factor);
  for (const Keywords& factor : keywords.factors("SYMETRIE")) mirror(mesh, factor);
  return keywords.has("ROTATION") || keywords.has("SYMETRIE");
}

/// A mesh without volumes that has come to lie in the plane z = 0 is one of the plane. @param size of coordinates that were
/// moved
void lie_down(Mesh& mesh, double size) {
  constexpr double round_off = 1e-14;
  if (mesh.dimension != 3) return;
  const bool volumes = std::ranges::any_of(mesh.types, [](const auto type) { return catalog::cell(type).dimension == 3; });
  if (volumes) return;
  const std::vector<double> in_space = mesh.coordinates;
  for (std::size_t n = 0; n < mesh.n_nodes(); ++n)
    if (double& z = mesh.coordinates[3 * n + 2]; std::abs(z) <= round_off * size) z = 0;
  mesh.dimension = least_dimension(mesh);
  if (mesh.dimension == 3) mesh.coordinates = in_space;
}

}  // namespace

bool transform(Mesh& mesh, const Keywords& keywords) {
  // What is scaled to next to nothing is not flat; what moves from far away is as flat as coordinates there can tell.
  const double before = keywords.has("ECHELLE") ? 0 : largest(mesh);
  if (asks_for_space(keywords)) mesh.dimension = 3;
  if (!move(mesh, keywords)) return false;
  lie_down(mesh, std::max(before, largest(mesh)));
  return true;
}

}  // namespace lacon
