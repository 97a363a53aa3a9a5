#include "lacon/operators/modi_maillage/transform.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "lacon/catalog/messages.hpp"
#include "lacon/operators/meshing/body.hpp"

namespace lacon {
namespace {

using Vector = std::array<double, 3>;

[[noreturn]] void refuse(const Keywords& keywords, const char* keyword, const std::string& expected) {
  fail("ORDER_4", {{"keyword", keywords.path(keyword)}, {"expected", expected}});
}

Vector vector(const Mesh& mesh, const Keywords& keywords, const char* keyword) {
  const std::vector<double> given = keywords.reals(keyword);
  if (given.size() != static_cast<std::size_t>(mesh.dimension))
    refuse(keywords, keyword, "as many numbers as the mesh has dimensions, " + std::to_string(mesh.dimension));
  Vector made{};
  std::ranges::copy(given, made.begin());
  return made;
}

Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vector unit(const Keywords& keywords, const char* keyword, const Vector& given) {
  const double length = std::sqrt(dot(given, given));
  if (!(length > 0)) refuse(keywords, keyword, "a direction: not zero, and not parallel to the other one");
  return {given[0] / length, given[1] / length, given[2] / length};
}

template <class Move>
void each_node(Mesh& mesh, const Move& move) {
  for (std::size_t n = 0; n < mesh.n_nodes(); ++n) {
    const Vector moved = move(Vector{mesh.coordinates[3 * n], mesh.coordinates[3 * n + 1], mesh.coordinates[3 * n + 2]});
    std::ranges::copy(moved, mesh.coordinates.begin() + static_cast<std::ptrdiff_t>(3 * n));
  }
}

/// Rodrigues' formula about the axis through `from`.
void rotate(Mesh& mesh, const Keywords& factor) {
  const Vector from = vector(mesh, factor, "POIN_1");
  Vector axis{0, 0, 1};
  if (mesh.dimension == 3) {
    const char* keyword = factor.has("POIN_2") ? "POIN_2" : "DIR";
    if (!factor.has(keyword)) refuse(factor, "DIR", "given, or POIN_2, for a mesh of three dimensions");
    axis = vector(mesh, factor, keyword);
    if (factor.has("POIN_2"))
      for (std::size_t k = 0; k < 3; ++k) axis[k] -= from[k];
    axis = unit(factor, keyword, axis);
  }
  const double angle = factor.real("ANGLE") * std::numbers::pi / 180, c = std::cos(angle), s = std::sin(angle);
  each_node(mesh, [&](const Vector& x) {
    const Vector r{x[0] - from[0], x[1] - from[1], x[2] - from[2]}, turned = cross(axis, r);
    const double along = dot(axis, r) * (1 - c);
    Vector moved;
    for (std::size_t k = 0; k < 3; ++k) moved[k] = from[k] + c * r[k] + s * turned[k] + along * axis[k];
    return moved;
  });
}

void mirror(Mesh& mesh, const Keywords& factor) {
  const Vector point = vector(mesh, factor, "POINT"), first = vector(mesh, factor, "AXE_1");
  Vector second{0, 0, 1};
  if (mesh.dimension == 3) {
    if (!factor.has("AXE_2")) refuse(factor, "AXE_2", "given, for a mesh of three dimensions");
    second = vector(mesh, factor, "AXE_2");
  }
  const Vector normal = unit(factor, "AXE_1", cross(first, second));
  each_node(mesh, [&](const Vector& x) {
    const double distance = dot(normal, {x[0] - point[0], x[1] - point[1], x[2] - point[2]});
    return Vector{x[0] - 2 * distance * normal[0], x[1] - 2 * distance * normal[1], x[2] - 2 * distance * normal[2]};
  });
  for (std::size_t c = 0; c < mesh.n_cells(); ++c)
    std::ranges::copy(mirrored(mesh.types[c], mesh.cells[c]), mesh.cells[c].begin());
}

}  // namespace

bool transform(Mesh& mesh, const Keywords& keywords) {
  if (keywords.has("TRANSLATION")) {
    const Vector by = vector(mesh, keywords, "TRANSLATION");
    each_node(mesh, [&](const Vector& x) { return Vector{x[0] + by[0], x[1] + by[1], x[2] + by[2]}; });
    return true;
  }
  if (keywords.has("ECHELLE")) {
    const double scale = keywords.real("ECHELLE");
    each_node(mesh, [&](const Vector& x) { return Vector{scale * x[0], scale * x[1], scale * x[2]}; });
    return true;
  }
  if (keywords.has("SYMETRIE")) refuse_cut_mesh(mesh, "SYMETRIE");
  for (const Keywords& factor : keywords.factors("ROTATION")) rotate(mesh, factor);
  for (const Keywords& factor : keywords.factors("SYMETRIE")) mirror(mesh, factor);
  return keywords.has("ROTATION") || keywords.has("SYMETRIE");
}

}  // namespace lacon
