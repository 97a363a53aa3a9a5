#include "lacon/operators/contact/facets.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "lacon/pairing/normals.hpp"

namespace lacon {
namespace {

// Radians, between a facet and the normals at its corners: half the angle of ten edges a turn.
constexpr double largest_turn = 0.32;
// Slope of a curve in the middle of its facet, over what it turns by from there to a corner: 1 where normals turn at one end
// alone, a third where a curve ends in a plane.
constexpr double one_sided = 0.6;
constexpr double straight = 1e-9;  // a slope that is round-off

}  // namespace

FacetArc::FacetArc(std::span<const Vec3> corners, std::span<const Vec3> normals, Vec3 outward)
    : outward_(outward / norm(outward)) {
  const auto n = static_cast<Eigen::Index>(corners.size());
  if (n < 2) return;  // of cells without extent
  const Eigen::Index directions = n == 2 ? 1 : 2;
  for (const Vec3 corner : corners) middle_ = middle_ + corner / static_cast<double>(n);
  for (const Vec3 corner : corners) corners_.push_back(corner - middle_);
  const Vec3 side = corners[1] - corners[0];
  along_[0] = side - dot(side, outward_) * outward_;
  along_[0] = along_[0] / norm(along_[0]);
  if (directions == 2) along_[1] = cross(outward_, along_[0]);
  // slopes of a quadratic function: those in the middle, and bend times place
  Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(n * directions, 3 * directions - 1);
  Eigen::VectorXd wanted(n * directions);
  for (Eigen::Index k = 0; k < n; ++k) {
    const Vec3 normal = normals[static_cast<std::size_t>(k)];
    const double up = dot(normal, outward_);
    turn_ = std::max(turn_, std::acos(std::clamp(up, -1.0, 1.0)));
    for (Eigen::Index d = 0; d < directions; ++d) {
      const Eigen::Index row = k * directions + d;
      wanted[row] = -dot(normal, along_[d]) / up;
      slopes(row, d) = 1;
      for (Eigen::Index e = 0; e < directions; ++e)
        slopes(row, directions + d + e) = dot(corners_[static_cast<std::size_t>(k)], along_[e]);
    }
  }
  if (!(turn_ < largest_turn)) return;
  const Eigen::VectorXd found = slopes.completeOrthogonalDecomposition().solve(wanted);
  for (Eigen::Index i = 0; i < found.size() - directions; ++i) bend_[i] = found[directions + i];
  pass_corners();
  double turned = 0, off = 0;
  for (const Vec3 corner : corners_) {
    const double x = dot(corner, along_[0]), y = dot(corner, along_[1]);
    turned = std::max(turned, std::hypot(bend_[0] * x + bend_[1] * y, bend_[1] * x + bend_[2] * y));
  }
  for (Eigen::Index d = 0; d < directions; ++d) off = std::hypot(off, found[d] - slope_[d]);
  is_of_curve_ = off <= std::max(one_sided * turned, straight);
}

void FacetArc::bend_as(const FacetArc& neighbour) {
  if (!(turn_ < largest_turn)) return;
  const auto bent = [&](Vec3 v) {  // by the neighbour, as a tensor of space
    const double x = dot(v, neighbour.along_[0]), y = dot(v, neighbour.along_[1]);
    const double* const bend = neighbour.bend_;
    return (bend[0] * x + bend[1] * y) * neighbour.along_[0] + (bend[1] * x + bend[2] * y) * neighbour.along_[1];
  };
  bend_[0] = dot(along_[0], bent(along_[0]));
  bend_[1] = dot(along_[0], bent(along_[1]));
  bend_[2] = dot(along_[1], bent(along_[1]));
  pass_corners();
  is_of_curve_ = true;
}

void FacetArc::pass_corners() {
  Eigen::Matrix2d bend;
  bend << bend_[0], bend_[1], bend_[1], bend_[2];
  curvature_ = bend.selfadjointView<Eigen::Lower>().eigenvalues().cwiseAbs().maxCoeff();
  const auto n = static_cast<Eigen::Index>(corners_.size());
  Eigen::MatrixXd plane(n, 3);
  Eigen::VectorXd heights(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const Vec3 corner = corners_[static_cast<std::size_t>(k)];
    const Eigen::Vector2d at(dot(corner, along_[0]), dot(corner, along_[1]));
    plane.row(k) << 1, at.transpose();
    heights[k] = dot(corner, outward_) - 0.5 * at.dot(bend * at);
  }
  const Eigen::Vector3d through = plane.completeOrthogonalDecomposition().solve(heights);
  height_ = through[0], slope_[0] = through[1], slope_[1] = through[2];
}

double FacetArc::missing(Vec3 place) const {
  const Vec3 from = place - middle_;
  const double x = dot(from, along_[0]), y = dot(from, along_[1]);
  return height_ + slope_[0] * x + slope_[1] * y + 0.5 * (bend_[0] * x * x + 2 * bend_[1] * x * y + bend_[2] * y * y) -
         dot(from, outward_);
}

std::vector<std::uint8_t> inner_nodes(const Surface& skin, std::span<const std::int32_t> facet_of) {
  std::map<std::tuple<std::int32_t, std::int32_t, std::int32_t>, int> cells_at;  // sides of the cells of each facet
  std::vector<std::uint8_t> inner(skin.coordinates.size() / 3, 0);
  for (std::size_t cell = 0; cell < skin.size(); ++cell) {
    const auto nodes = skin.nodes[cell];
    const auto n = static_cast<std::size_t>(catalog::cell(skin.types[cell]).n_vertices);
    for (std::size_t i = 0; i < n; ++i) {
      const auto [a, b] = std::minmax(nodes[i], nodes[skin.dimension == 2 ? i : (i + 1) % n]);
      ++cells_at[{facet_of[cell], a, b}];
      inner[static_cast<std::size_t>(nodes[i])] = 1;
    }
  }
  for (const auto& [side, count] : cells_at)
    if (count == 1) inner[static_cast<std::size_t>(std::get<1>(side))] = inner[static_cast<std::size_t>(std::get<2>(side))] = 0;
  return inner;
}

std::vector<FacetArc> arcs_of_cells(const Surface& skin, std::span<const std::int32_t> facet_of) {
  const std::vector<double> normals = nodal_normals(skin);
  const std::vector<std::uint8_t> inner = inner_nodes(skin, facet_of);
  struct Facet {
    std::vector<std::int32_t> corners;
    Vec3 outward{};
  };
  std::map<std::int32_t, Facet> facets;
  for (std::size_t cell = 0; cell < skin.size(); ++cell) {
    Facet& facet = facets[facet_of[cell]];
    facet.outward = facet.outward + normal_of(skin.types[cell], skin.nodes[cell], skin.coordinates);
    for (const std::int32_t node : skin.nodes[cell].first(static_cast<std::size_t>(catalog::cell(skin.types[cell]).n_vertices)))
      if (inner[static_cast<std::size_t>(node)] == 0 && std::ranges::find(facet.corners, node) == facet.corners.end())
        facet.corners.push_back(node);
  }
  std::map<std::int32_t, FacetArc> arcs;
  std::map<std::int32_t, std::vector<std::int32_t>> around;  // the facets of a corner
  for (const auto& [number, facet] : facets) {
    std::vector<Vec3> places, normals_there;
    for (const std::int32_t node : facet.corners) {
      places.push_back(vector_at(&skin.coordinates[3 * static_cast<std::size_t>(node)]));
      normals_there.push_back(vector_at(&normals[3 * static_cast<std::size_t>(node)]));
      around[node].push_back(number);
    }
    arcs.emplace(number, FacetArc(places, normals_there, facet.outward));
  }
  // at the ends of a skin, from facets beside them that share an end, in space a side
  const std::vector<std::uint8_t> inside = inner_nodes(skin, std::vector<std::int32_t>(skin.size(), 0));
  const std::map<std::int32_t, FacetArc> alone = arcs;
  for (auto& [number, arc] : arcs) {
    const std::vector<std::int32_t>& corners = facets.at(number).corners;
    if (arc.is_of_curve() || std::ranges::all_of(corners, [&](std::int32_t node) { return inside[node] != 0; })) continue;
    std::map<std::int32_t, int> shared;
    for (const std::int32_t node : corners)
      for (const std::int32_t other : around[node])
        if (other != number && ++shared[other] == skin.dimension - 1 && alone.at(other).is_of_curve())
          arc.bend_as(alone.at(other));
  }
  std::vector<FacetArc> of_cells;
  for (std::size_t cell = 0; cell < skin.size(); ++cell) of_cells.push_back(arcs.at(facet_of[cell]));
  return of_cells;
}

}  // namespace lacon
