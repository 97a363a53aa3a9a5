#include "lacon/pairing/target.hpp"

#include <algorithm>
#include <cmath>

namespace lacon::space {

Target::Target(const FacetKind& f, const Nodes& nodes, const SlaveFacet& slave)
    : slave_(slave), family_(f.family), x_(f.map(nodes)) {
  size_ = f.size + norm(x_.c[0]) + slave.f.size;
  if (slave.constant) along_ = Inverse(project(x_, slave.e1, slave.e2), family_);
}

std::optional<Vec2> Target::image(Vec2 y, Vec2 xi, const PairingTolerances& tolerances) const {
  if (slave_.constant) return along_(y, tolerances.ray * size_, tolerances.margin);
  const Vec3 x = slave_.f.x(xi).x, n = slave_.direction(xi);
  const Vec3 axis = std::abs(n.x) <= std::abs(n.y) && std::abs(n.x) <= std::abs(n.z) ? Vec3{1, 0, 0}
                    : std::abs(n.y) <= std::abs(n.z)                                 ? Vec3{0, 1, 0}
                                                                                     : Vec3{0, 0, 1};
  const Vec3 t = cross(n, axis), e1 = (1 / norm(t)) * t, e2 = cross(n, e1);
  return inverse(project(x_, e1, e2), family_, {dot(x, e1), dot(x, e2)}, tolerances.ray * size_, tolerances.margin);
}

void Target::images(std::span<const Vec2> y, std::span<const SlaveFacet::Place> places, const PairingTolerances& tolerances,
                    std::vector<Line>& lines, std::vector<Meeting>& images) const {
  images.resize(y.size());
  if (slave_.constant && along_.affine()) {
    for (std::size_t i = 0; i < y.size(); ++i) {
      const Vec2 xi = along_.of_affine(y[i]);
      images[i] = {places[i].found && near_reference_cell(family_, xi, tolerances.margin), xi, 0};
    }
    return;
  }
  lines.clear();
  for (std::size_t i = 0; i < y.size(); ++i)
    if (slave_.constant)
      lines.push_back(slave_.normal_at(y[i]));
    else
      lines.push_back({slave_.f.x(places[i].xi).x, slave_.direction(places[i].xi)});
  meet(x_, family_, lines, tolerances.ray * size_, tolerances.margin, images);
  for (std::size_t i = 0; i < y.size(); ++i) {
    images[i].found = images[i].found && places[i].found;
    if (images[i].found || !places[i].found) continue;
    if (const std::optional<Vec2> found = image(y[i], places[i].xi, tolerances)) images[i] = {true, *found, 0};
  }
}

void cut_in_parts(const FacetKind& f, const Nodes& nodes, const SlaveFacet& slave, std::vector<Vec3>& polygon,
                  std::vector<Part>& parts) {
  parts.clear();
  const auto add = [&](std::size_t i, std::size_t j, std::size_t k) {
    parts.push_back({3,
                     {polygon[i], polygon[j], polygon[k]},
                     {static_cast<std::int32_t>(i), static_cast<std::int32_t>(j), static_cast<std::int32_t>(k)}});
  };
  outline(f, nodes, polygon);
  const std::size_t n = polygon.size();
  if (n == 3) {
    parts.push_back({3, {polygon[0], polygon[1], polygon[2]}, {0, 1, 2}});
  } else if (n == 4) {
    // a corner that turns the other way is where a diagonal must start
    std::array<double, 4> corner;
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      corner[i] = dot(cross(polygon[i] - polygon[(i + 3) % 4], polygon[(i + 1) % 4] - polygon[i]), slave.n);
      sum += corner[i];
    }
    std::size_t reflex = 0;
    for (std::size_t i = 1; i < 4; ++i)
      if (corner[i] * sum < corner[reflex] * sum) reflex = i;
    if (slave.constant && corner[reflex] * sum >= 0)
      parts.push_back({4, {polygon[0], polygon[1], polygon[2], polygon[3]}, {0, 1, 2, 3}});
    else
      for (const std::size_t k : {std::size_t{1}, std::size_t{2}}) add(reflex, (reflex + k) % 4, (reflex + k + 1) % 4);
  } else {
    const Vec3 centre = f.map(nodes)(probes(f.family).back()).x;
    for (std::size_t i = 0; i < n; ++i) {
      add(i, i, (i + 1) % n);
      parts.back().p[0] = centre;
      parts.back().place[0] = -1;
    }
  }
}

void see(const SlaveFacet& slave, const Piece& piece, const Part& part, bool front, Region& seen, Polygon& scratch) {
  seen.polygon.clear();
  seen.halves.clear();
  const auto outside = [](const HalfPlane& half) { return [&half](Vec2 y) { return half(y) < 0; }; };
  for (int i = 0; i < part.n; ++i) {
    HalfPlane half = slave.side(piece, part.p[i], part.p[(i + 1) % part.n]);
    half.line = part.line[static_cast<std::size_t>(i)];
    seen.halves.push_back(front ? half : half.opposite());
    // most masters that come near are seen by few pieces
    if (std::all_of(piece.polygon.begin(), piece.polygon.end(), outside(seen.halves.back()))) return;
  }
  seen.polygon = piece.polygon;
  for (const HalfPlane& half : seen.halves) {
    clip(seen.polygon, half, scratch);
    seen.polygon.swap(scratch);
  }
}

}  // namespace lacon::space
