#include "lacon/pairing/thickness.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "lacon/structures/parallel.hpp"
#include "lacon/structures/vector.hpp"

namespace lacon {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double on_the_edge = 1e-6;  // of a facet: ways that meet an edge miss neither of its cells by round-off
constexpr double parallel = 1e-6;     // cosine

struct Way {
  Vec3 from, along;  ///< the latter unit
};

/// How far it is to a segment of the plane.
double to_segment(const Way& way, Vec3 a, Vec3 b) {
  const Vec3 side = b - a, start = a - way.from;
  const Vec2 d{way.along.x, way.along.y}, e{side.x, side.y}, s{start.x, start.y};
  const double size = cross(d, e), at = cross(s, d) / size;
  return std::abs(size) > parallel * norm(e) && std::abs(at - 0.5) <= 0.5 + on_the_edge ? cross(s, e) / size : infinite;
}

double to_triangle(const Way& way, Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 u = b - a, v = c - a, s = way.from - a, normal = cross(u, v);
  const double size = -dot(way.along, normal);
  if (!(std::abs(size) > parallel * norm(normal))) return infinite;
  const Vec3 turned = cross(s, way.along);
  const double r = dot(v, turned) / size, t = -dot(u, turned) / size;
  return r >= -on_the_edge && t >= -on_the_edge && r + t <= 1 + on_the_edge ? dot(s, normal) / size : infinite;
}

double to_cell(const Way& way, const Surface& skin, std::size_t cell) {
  const auto at = [&](std::size_t i) { return vector_at(skin.coordinates.data() + 3 * std::ptrdiff_t{skin.nodes[cell][i]}); };
  const int n = catalog::cell(skin.types[cell]).n_vertices;
  if (n == 2) return to_segment(way, at(0), at(1));
  const double first = to_triangle(way, at(0), at(1), at(2));
  return n == 3 ? first : std::min(first, to_triangle(way, at(0), at(2), at(3)));
}

/// Whether a way passes a box.
bool passes(const Way& way, const Box<3>& box) {
  double first = 0, last = infinite;
  for (int d = 0; d < 3; ++d) {
    const double from = component(way.from, d), along = component(way.along, d);
    if (along == 0) {
      if (from < box.low[d] || from > box.high[d]) return false;
      continue;
    }
    const double low = (box.low[d] - from) / along, high = (box.high[d] - from) / along;
    first = std::max(first, std::min(low, high));
    last = std::min(last, std::max(low, high));
  }
  return first <= last;
}

Box<3> box_of(const Surface& skin, std::size_t cell) {
  Box<3> box = Box<3>::empty();
  for (const std::int32_t node : skin.nodes[cell]) box.add(skin.coordinates.data() + 3 * std::ptrdiff_t{node});
  double size = 0;
  for (int d = 0; d < 3; ++d) size = std::max(size, box.high[d] - box.low[d]);
  for (int d = 0; d < 3; ++d) {
    box.low[d] -= on_the_edge * size;
    box.high[d] += on_the_edge * size;
  }
  return box;
}

}  // namespace

WaysThrough::WaysThrough(std::vector<const Surface*> skins) : skins_(std::move(skins)), tree_({}) {
  std::vector<Box<3>> boxes;
  for (std::size_t k = 0; k < skins_.size(); ++k)
    for (std::size_t cell = 0; cell < skins_[k]->size(); ++cell) {
      boxes.push_back(box_of(*skins_[k], cell));
      cells_.push_back({static_cast<std::int32_t>(k), static_cast<std::int32_t>(cell),
                        normal_of(skins_[k]->types[cell], skins_[k]->nodes[cell], skins_[k]->coordinates)});
    }
  tree_ = BoxTree<3>(std::move(boxes));
}

double WaysThrough::to_leave(std::int32_t body, Vec3 from, Vec3 along) const {
  const Way way{from, along};
  double nearest = infinite;
  tree_.visit([&](const Box<3>& box) { return passes(way, box); },
              [&](std::int32_t i) {
                const Cell& at = cells_[static_cast<std::size_t>(i)];
                const Surface& skin = *skins_[static_cast<std::size_t>(at.skin)];
                if (!(dot(at.normal, along) > 0) || body_of(skin, static_cast<std::size_t>(at.cell)) != body) return;
                const double far = to_cell(way, skin, static_cast<std::size_t>(at.cell));
                if (far > 0) nearest = std::min(nearest, far);
              });
  return nearest;
}

std::vector<double> thickness(const Surface& skin, const WaysThrough& ways) {
  constexpr std::size_t block = 512;  // cells that a thread measures at a time
  std::vector<double> found(skin.size());
  parallel_for(skin.size(), block, [&](const LoopBlock& cells) {
    for (std::size_t cell = cells.first; cell < cells.last; ++cell)
      found[cell] = ways.to_leave(body_of(skin, cell), middle_of(skin.nodes[cell], skin.coordinates),
                                  -1.0 * normal_of(skin.types[cell], skin.nodes[cell], skin.coordinates));
  });
  return found;
}

}  // namespace lacon
