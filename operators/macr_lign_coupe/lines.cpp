#include "lacon/operators/macr_lign_coupe/lines.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "lacon/catalog/messages.hpp"
#include "lacon/operators/meshing/chain.hpp"
#include "lacon/structures/vector.hpp"

namespace lacon {
namespace {

using Eigen::Vector3d;

/// A keyword with as many coordinates as the space has.
Vector3d coordinates(const Mesh& mesh, const Keywords& line, const char* keyword) {
  const std::vector<double> given = line.reals(keyword);
  if (given.size() != static_cast<std::size_t>(mesh.dimension))
    fail(
        "LIGNCOUPE_3",
        {{"keyword", line.path(keyword)}, {"found", std::to_string(given.size())}, {"wanted", std::to_string(mesh.dimension)}});
  Vector3d point = Vector3d::Zero();
  std::copy(given.begin(), given.end(), point.data());
  return point;
}

LinePoint at(const Vector3d& point, double along) { return {along, {point[0], point[1], point[2]}, {}, {}}; }

std::vector<LinePoint> segment(const Mesh& mesh, const Keywords& line) {
  const Vector3d first = coordinates(mesh, line, "COOR_ORIG"), last = coordinates(mesh, line, "COOR_EXTR");
  const std::int64_t n = line.integer("NB_POINTS");
  std::vector<LinePoint> points;
  for (std::int64_t i = 0; i < n; ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(n - 1);
    points.push_back(at((1 - t) * first + t * last, t * (last - first).norm()));
  }
  return points;
}

std::vector<LinePoint> arc(const Mesh& mesh, const Keywords& line) {
  const Vector3d centre = coordinates(mesh, line, "CENTRE"), first = coordinates(mesh, line, "COOR_ORIG");
  Vector3d axis = Vector3d::UnitZ();
  if (mesh.dimension == 3) {
    if (!line.has("DNOR")) fail("LIGNCOUPE_8", {{"keyword", line.path("DNOR")}});
    axis = coordinates(mesh, line, "DNOR");
  }
  const Vector3d arm = first - centre;
  if (axis.norm() == 0 || arm.norm() == 0 || std::abs(axis.normalized().dot(arm)) > 1e-6 * arm.norm())
    fail("LIGNCOUPE_8", {{"keyword", line.path(mesh.dimension == 3 ? "DNOR" : "CENTRE")}});
  const double angle = line.real("ANGLE") * std::numbers::pi / 180;
  const std::int64_t n = line.integer("NB_POINTS");
  std::vector<LinePoint> points;
  for (std::int64_t i = 0; i < n; ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(n - 1);
    const Vector3d point = centre + Eigen::AngleAxisd(t * angle, axis.normalized()) * arm;
    points.push_back(at(point, t * std::abs(angle) * arm.norm()));
  }
  return points;
}

std::vector<LinePoint> at_nodes(const Mesh& mesh, std::span<const std::int32_t> nodes) {
  std::vector<LinePoint> points;
  for (const std::int32_t node : nodes) {
    const Eigen::Map<const Vector3d> here(mesh.point(static_cast<std::size_t>(node)).data());
    LinePoint point = at(here, 0);
    if (!points.empty())
      point.along = points.back().along + (here - Eigen::Map<const Vector3d>(points.back().position.data())).norm();
    point.nodes = {node};
    point.weights = {1.0};
    points.push_back(std::move(point));
  }
  return points;
}

/// Find the cell of each point.
void locate(std::vector<LinePoint>& points, const Mesh& mesh, const CellLocator& locator, const Keywords& line) {
  std::optional<double> limit;
  if (line.has("DISTANCE_MAX")) limit = line.real("DISTANCE_MAX");
  const auto show = [&](const LinePoint& point) {
    return fmt::format("({:.6g})", fmt::join(point.position.begin(), point.position.begin() + mesh.dimension, ", "));
  };
  const double silent = line.optional_real("DISTANCE_ALARME").value_or(limit ? HUGE_VAL : 0.0);
  int outside = 0;
  double furthest = 0;
  std::string where;
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::optional<PointInCell> found = locator.find(points[i].position, limit);
    if (!found)
      fail("LIGNCOUPE_1", {{"keyword", line.path("TYPE")}, {"number", std::to_string(i + 1)}, {"point", show(points[i])}});
    const auto cell = static_cast<std::size_t>(found->cell);
    points[i].nodes.assign(mesh.cells[cell].begin(), mesh.cells[cell].end());
    points[i].weights = std::move(found->weights);
    if (!found->outside || found->distance <= silent) continue;
    ++outside;
    if (found->distance >= furthest) {
      furthest = found->distance;
      where = show(points[i]);
    }
  }
  if (outside > 0)
    inform("LIGNCOUPE_2", {{"keyword", line.path("TYPE")},
                           {"count", std::to_string(outside)},
                           {"distance", fmt::format("{:.3g}", furthest)},
                           {"point", where}});
}

}  // namespace

std::vector<LinePoint> line_points(const Mesh& mesh, const CellLocator& locator, const Keywords& line) {
  const std::string type = line.text("TYPE");
  if (type == "GROUP_NO") return at_nodes(mesh, nodes_of_group(mesh, line.text("GROUP_NO"), line.path("GROUP_NO")));
  if (type == "GROUP_MA") return at_nodes(mesh, chain_of_lines(mesh, line.text("GROUP_MA"), line.path("GROUP_MA")));
  std::vector<LinePoint> points = type == "ARC" ? arc(mesh, line) : segment(mesh, line);
  if (points.back().along == 0)
    inform("LIGNCOUPE_14",
           {{"keyword", line.path(type == "ARC" ? "ANGLE" : "COOR_EXTR")}, {"count", std::to_string(points.size())}});
  locate(points, mesh, locator, line);
  return points;
}

std::vector<std::array<double, 3>> positions(const std::vector<LinePoint>& points) {
  std::vector<std::array<double, 3>> found;
  for (const LinePoint& point : points) found.push_back(point.position);
  return found;
}

std::vector<std::array<double, 3>> positions_now(const std::vector<LinePoint>& points, const std::vector<double>& coordinates) {
  std::vector<std::array<double, 3>> now(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t a = 0; a < points[i].nodes.size(); ++a)
      for (std::size_t d = 0; d < 3; ++d)
        now[i][d] += points[i].weights[a] * coordinates[3 * static_cast<std::size_t>(points[i].nodes[a]) + d];
  return now;
}

void tell_of_turns(const std::vector<LinePoint>& points, const Keywords& line) {
  std::size_t count = 0, first = 0;
  const auto step = [&](std::size_t i) {
    return vector_at(points[i + 1].position.data()) - vector_at(points[i].position.data());
  };
  for (std::size_t i = 1; i + 1 < points.size(); ++i)
    if (dot(step(i - 1), step(i)) < -0.9 * norm(step(i - 1)) * norm(step(i)) && count++ == 0) first = i;
  if (count > 0)
    inform("POST_10", {{"count", std::to_string(count)},
                       {"place", fmt::format("{} ({:g})", line.path("TYPE"), fmt::join(points[first].position, ", "))}});
}

}  // namespace lacon
