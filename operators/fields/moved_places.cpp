#include "lacon/operators/fields/moved_places.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "lacon/catalog/messages.hpp"
#include "lacon/structures/displacement.hpp"

namespace lacon {
namespace {

using Place3 = Eigen::Map<const Eigen::Vector3d>;

/// Of the size of the mesh: places that are nearer to an axis or a point have no direction and no lever arm to speak of.
constexpr double near = 1e-2;

double size_of(const Mesh& mesh) {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(INFINITY), high = -low;
  for (std::size_t n = 0; n < mesh.n_nodes(); ++n) {
    const Place3 place(mesh.point(n).data());
    low = low.cwiseMin(place), high = high.cwiseMax(place);
  }
  return mesh.n_nodes() > 0 ? (high - low).norm() : 0;
}

double length_of(const std::array<double, 3>& vector) { return Place3(vector.data()).norm(); }

}  // namespace

MovedPlaces::MovedPlaces(const Base& base, const Result& result, const Mesh& mesh)
    : base_(base), result_(result), mesh_(mesh), size_(size_of(mesh)) {}

const std::vector<double>& MovedPlaces::at(std::int64_t order) {
  if (order == order_) return coordinates_;
  order_ = order;
  coordinates_.clear();
  const auto files = result_.fields.find("DEPL");
  if (files != result_.fields.end() && files->second.contains(order) && mesh_.first_place.empty())
    coordinates_ = displaced(mesh_, base_.field(result_, "DEPL", order));
  return coordinates_;
}

void MovedPlaces::look_at_axes(const std::string& keyword, double instant, const Frame& frame, const Places& before,
                               const Places& now) {
  double largest = 0, way = 0, angle = 0;  // of a place on its circle
  for (std::size_t i = 0; i < before.size(); ++i) {
    const Eigen::Vector3d from = frame.radius(Place3(before[i].data())), to = frame.radius(Place3(now[i].data()));
    const double turned = std::atan2(from.cross(to).norm(), from.dot(to));
    largest = std::max(largest, from.norm());
    if (from.norm() < near * size_) continue;
    if (turned * from.norm() <= way) continue;
    way = turned * from.norm();
    angle = turned;
  }
  if (!(way > axes_.share * largest)) return;
  axes_ = {.share = way / largest, .keyword = keyword, .instant = instant, .angle = angle * 180 / std::numbers::pi};
}

void MovedPlaces::look_at_moment(const std::string& keyword, double instant, const std::vector<double>& origin,
                                 const Places& before, const Places& now, double forces, const std::array<double, 3>& found,
                                 const std::array<double, 3>& then) {
  double arm = near * size_, way = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    arm = std::max(arm, (Place3(before[i].data()) - Place3(origin.data())).norm());
    way = std::max(way, (Place3(now[i].data()) - Place3(before[i].data())).norm());
  }
  // A moment below a thousandth of what these forces could make is none, and its change is round-off.
  const double change = (Place3(then.data()) - Place3(found.data())).norm(),
               told = std::max(0.05 * std::max(length_of(found), length_of(then)), 1e-3 * forces * std::max(arm, way));
  if (!(way > moment_.share * arm) || !(change > told)) return;
  moment_ = {.share = way / arm, .keyword = keyword, .instant = instant, .found = found, .then = then};
}

void MovedPlaces::tell() const {
  if (!axes_.keyword.empty())
    inform("MODIREPERE_6", {{"keyword", axes_.keyword},
                            {"instant", fmt::format("{:.9g}", axes_.instant)},
                            {"angle", fmt::format("{:.3g}", axes_.angle)}});
  if (!moment_.keyword.empty())
    inform("POST_13", {{"keyword", moment_.keyword},
                       {"instant", fmt::format("{:.9g}", moment_.instant)},
                       {"share", fmt::format("{:.3g}", 100 * moment_.share)},
                       {"found", fmt::format("{:.6g}", fmt::join(moment_.found, ", "))},
                       {"then", fmt::format("{:.6g}", fmt::join(moment_.then, ", "))}});
}

}  // namespace lacon
