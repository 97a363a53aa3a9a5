#include "lacon/operators/fields/moved_places.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "lacon/catalog/messages.hpp"
#include "lacon/structures/displacement.hpp"
#include "lacon/structures/hdf5.hpp"

namespace lacon {
namespace {

using Place3 = Eigen::Map<const Eigen::Vector3d>;

/// Whether the last command that changed the mesh was MODI_MAILLAGE with DEFORME.
bool is_deformed(const Base& base, const std::string& mesh) {
  const hdf5::Reader root(base.file(mesh));
  return root.has_attribute("keywords") && nlohmann::json::parse(root.text("keywords"), nullptr, false).contains("DEFORME");
}

double length_of(const std::array<double, 3>& vector) { return Place3(vector.data()).norm(); }

}  // namespace

const std::vector<double>& MovedPlaces::at(std::int64_t order) {
  if (order == order_) return coordinates_;
  order_ = order;
  coordinates_.clear();
  const auto files = result_.fields.find("DEPL");
  if (files != result_.fields.end() && files->second.contains(order) && !is_deformed(base_, result_.mesh))
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
  double arm = 0, way = 0;
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
