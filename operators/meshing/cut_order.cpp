#include "lacon/operators/meshing/cut_order.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <unordered_map>

#include "lacon/structures/vector.hpp"

namespace lacon {
namespace {

constexpr double equal = 1e-6;  ///< differences below this fraction decide nothing

Vec3 point_of(const Mesh& mesh, std::int32_t node) {
  return vector_at(mesh.coordinates.data() + 3 * static_cast<std::size_t>(node));
}

/// Size and middle of a slave cell, by its vertices.
struct Extent {
  double size = 0;
  Vec3 middle;
};

Extent extent(const Mesh& mesh, std::int32_t cell) {
  const auto nodes = mesh.cells[static_cast<std::size_t>(cell)];
  const auto n = static_cast<std::size_t>(mesh.row(static_cast<std::size_t>(cell)).n_vertices);
  const Vec3 origin = point_of(mesh, nodes[0]);
  Vec3 sum{}, area{};
  for (std::size_t i = 1; i < n; ++i) {
    const Vec3 at = point_of(mesh, nodes[i]) - origin;
    sum = sum + at;
    if (i + 1 < n) area = area + 0.5 * cross(at, point_of(mesh, nodes[i + 1]) - origin);
  }
  return {n == 2 ? norm(sum) : norm(area), origin + sum / static_cast<double>(n)};
}

}  // namespace

std::vector<std::size_t> order_of_cuts(const Mesh& mesh, std::span<const Slave> slaves) {
  std::vector<std::size_t> order(slaves.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::unordered_map<std::int32_t, std::vector<std::size_t>> of_body;
  for (const std::size_t slave : order) of_body[slaves[slave].body].push_back(slave);
  if (of_body.size() == slaves.size()) return order;
  Vec3 middle{};
  double size = 0;
  std::vector<Extent> extents;
  for (const Slave& slave : slaves) {
    extents.push_back(extent(mesh, slave.cell));
    size += extents.back().size;
    middle = middle + extents.back().size * extents.back().middle;
  }
  middle = middle / size;
  const auto before = [&](std::size_t a, std::size_t b) {
    const Extent &one = extents[a], &other = extents[b];
    const Vec3 apart = other.middle - one.middle;
    const double far = norm(one.middle - middle), farther = norm(other.middle - middle);
    for (const auto& [mine, its, unit] : {std::tuple{one.size, other.size, one.size + other.size},
                                          {far, farther, norm(apart)},
                                          {apart.x, 0.0, norm(apart)},
                                          {apart.y, 0.0, norm(apart)},
                                          {apart.z, 0.0, norm(apart)}})
      if (std::abs(mine - its) > equal * unit) return mine > its;
    return false;
  };
  for (auto& [body, own] : of_body) {
    if (own.size() == 1) continue;
    const std::vector<std::size_t> places = own;
    std::vector<std::size_t> sorted;
    for (const std::size_t slave : own)
      sorted.insert(std::ranges::find_if(sorted, [&](std::size_t other) { return before(slave, other); }), slave);
    for (std::size_t k = 0; k < places.size(); ++k) order[places[k]] = sorted[k];
  }
  return order;
}

}  // namespace lacon
