#include "lacon/operators/evolution/free_bodies.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <map>

#include "lacon/structures/vector.hpp"

namespace lacon {
namespace {

/// Of the largest pivot: below it, a motion is held by nothing but round-off.
constexpr double negligible = 1e-10;

/// What holds a body: the sum of row^T row over its constraints, a row being what one makes of the rigid motions.
struct Held {
  Vec3 low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};
  Eigen::Matrix<double, 6, 6> gram = Eigen::Matrix<double, 6, 6>::Zero();
};

}  // namespace

std::set<std::int32_t> free_bodies(const StaticProblem& problem, const Bodies& bodies) {
  const bool of_revolution =
      std::ranges::any_of(problem.solids, [](const ElementSet& set) { return set.row->geometry == catalog::Geometry::axis; });
  std::map<std::int32_t, Held> held;
  for (const ElementSet& set : problem.solids)
    for (const std::int32_t cell : set.cells)
      for (const std::int32_t node : problem.mesh.cells[static_cast<std::size_t>(cell)]) {
        Held& body = held[bodies.of(node)];
        const Vec3 x = vector_at(&problem.mesh.coordinates[3 * static_cast<std::size_t>(node)]);
        body.low = {std::min(body.low.x, x.x), std::min(body.low.y, x.y), std::min(body.low.z, x.z)};
        body.high = {std::max(body.high.x, x.x), std::max(body.high.y, x.y), std::max(body.high.z, x.z)};
      }

  // what a motion moves a displacement by: three translations, and turns about the middle, scaled to the size of the body
  const auto add = [&](std::int64_t dof, double coefficient, std::map<std::int32_t, Eigen::Vector<double, 6>>& rows) {
    const auto node = static_cast<std::int32_t>(dof / problem.n_components());
    const auto axis = static_cast<int>(dof % problem.n_components());
    const auto body = held.find(bodies.of(node));
    if (axis >= problem.dimension || body == held.end()) return;
    const auto& [low, high, gram] = body->second;
    const Vec3 x = vector_at(&problem.mesh.coordinates[3 * static_cast<std::size_t>(node)]);
    const Vec3 lever = (2 / norm(high - low)) * (x - 0.5 * (low + high));
    Eigen::Vector<double, 6>& row = rows.try_emplace(body->first, Eigen::Vector<double, 6>::Zero()).first->second;
    row[axis] += coefficient;
    for (int turn = 0; turn < 3; ++turn) {
      const Vec3 about = {turn == 0 ? 1.0 : 0.0, turn == 1 ? 1.0 : 0.0, turn == 2 ? 1.0 : 0.0};
      row[3 + turn] += coefficient * component(cross(about, lever), axis);
    }
  };
  const auto constrain = [&](const std::map<std::int32_t, Eigen::Vector<double, 6>>& rows) {
    for (const auto& [body, row] : rows) held[body].gram += row * row.transpose();
  };
  for (std::size_t dof = 0; dof < problem.n_dofs(); ++dof)
    if (problem.imposed[dof]) {
      std::map<std::int32_t, Eigen::Vector<double, 6>> rows;
      add(static_cast<std::int64_t>(dof), 1, rows);
      constrain(rows);
    }
  for (const Spring& spring : problem.springs)
    for (int i = 0; i < problem.dimension; ++i) {
      if (spring.stiffness[static_cast<std::size_t>(i * (i + 1) / 2 + i)] == 0) continue;
      std::map<std::int32_t, Eigen::Vector<double, 6>> rows;
      add(std::int64_t{spring.first} * problem.n_components() + i, 1, rows);
      if (spring.second >= 0) add(std::int64_t{spring.second} * problem.n_components() + i, -1, rows);
      constrain(rows);
    }
  for (const TimedLoad& load : problem.loads)
    for (const DofRelation& relation : load.relations) {
      std::map<std::int32_t, Eigen::Vector<double, 6>> rows;
      for (std::size_t i = 0; i < relation.dofs.size(); ++i) add(relation.dofs[i], relation.coefficients[i], rows);
      constrain(rows);
    }

  // the motions that there are: x, y, z and turns about them
  const std::vector<int> motions = of_revolution            ? std::vector<int>{1}
                                   : problem.dimension == 2 ? std::vector<int>{0, 1, 5}
                                                            : std::vector<int>{0, 1, 2, 3, 4, 5};
  std::set<std::int32_t> free;
  for (const auto& [body, own] : held) {
    const Eigen::MatrixXd gram = own.gram(motions, motions);
    const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(gram).eigenvalues();
    if (values[0] <= negligible * std::max(1.0, values[values.size() - 1])) free.insert(body);
  }
  return free;
}

}  // namespace lacon
