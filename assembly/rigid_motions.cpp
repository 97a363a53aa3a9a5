#include "lacon/assembly/rigid_motions.hpp"

#include <algorithm>
#include <utility>

namespace lacon {
namespace {

/// Of the largest pivot: below it, a motion is held by nothing but round-off.
constexpr double negligible = 1e-10;

}  // namespace

RigidMotions::RigidMotions(BodyGeometry given) : geometry_(std::move(given)) {
  const BodyGeometry& geometry = geometry_;
  kinds_ = geometry.is_of_revolution ? std::vector<int>{1}
           : geometry.dimension == 2 ? std::vector<int>{0, 1, 5}
                                     : std::vector<int>{0, 1, 2, 3, 4, 5};
  for (std::size_t node = 0; node < geometry.body.size(); ++node) {
    if (geometry.body[node] < 0) continue;
    auto& [low, high] = boxes_[geometry.body[node]];
    const Vec3 x = vector_at(&geometry.coordinates[3 * node]);
    low = {std::min(low.x, x.x), std::min(low.y, x.y), std::min(low.z, x.z)};
    high = {std::max(high.x, x.x), std::max(high.y, x.y), std::max(high.z, x.z)};
  }
}

std::optional<RigidMotions::Row> RigidMotions::row(std::int64_t node, int axis) const {
  const auto at = static_cast<std::size_t>(node);
  const auto body = boxes_.find(geometry_.body[at]);
  if (axis >= geometry_.dimension || body == boxes_.end()) return std::nullopt;
  const auto& [low, high] = body->second;
  const Vec3 x = vector_at(&geometry_.coordinates[3 * at]);
  const Vec3 lever = (2 / norm(high - low)) * (x - 0.5 * (low + high));
  Row row{body->first, MotionVector::Zero()};
  row.by[axis] = 1;
  for (int turn = 0; turn < 3; ++turn) {
    const Vec3 about = {turn == 0 ? 1.0 : 0.0, turn == 1 ? 1.0 : 0.0, turn == 2 ? 1.0 : 0.0};
    row.by[3 + turn] = component(cross(about, lever), axis);
  }
  return row;
}

std::vector<std::int32_t> RigidMotions::bodies() const {
  std::vector<std::int32_t> bodies;
  for (const auto& [body, box] : boxes_) bodies.push_back(body);
  return bodies;
}

Eigen::Matrix<double, 6, Eigen::Dynamic> RigidMotions::free_of(const Eigen::Matrix<double, 6, 6>& gram) const {
  const Eigen::MatrixXd among = gram(kinds_, kinds_);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(among);
  const Eigen::VectorXd& values = solver.eigenvalues();
  Eigen::Index count = 0;
  while (count < values.size() && values[count] <= negligible * std::max(1.0, values[values.size() - 1])) ++count;
  Eigen::Matrix<double, 6, Eigen::Dynamic> free = Eigen::Matrix<double, 6, Eigen::Dynamic>::Zero(6, count);
  free(kinds_, Eigen::all) = solver.eigenvectors().leftCols(count);
  return free;
}

}  // namespace lacon
