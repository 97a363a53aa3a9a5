#include "lacon/operators/evolution/problem/free_bodies.hpp"

#include <algorithm>
#include <map>

namespace lacon {

BodyGeometry geometry_of(const StaticProblem& problem, const Bodies& bodies) {
  BodyGeometry geometry{.dimension = problem.dimension, .coordinates = problem.mesh.coordinates};
  geometry.is_of_revolution = problem.is_of_revolution();
  geometry.body.assign(problem.mesh.n_nodes(), -1);
  for (const ElementSet& set : problem.solids)
    for (const std::int32_t cell : set.cells)
      for (const std::int32_t node : problem.mesh.cells[static_cast<std::size_t>(cell)])
        geometry.body[static_cast<std::size_t>(node)] = bodies.of(node);
  return geometry;
}

std::set<std::int32_t> free_bodies(const StaticProblem& problem, const Bodies& bodies) {
  const BodyGeometry geometry = geometry_of(problem, bodies);
  const RigidMotions motions(geometry);
  // what holds a body: the sum of row row^T over its constraints, a row being what one makes of the rigid motions
  std::map<std::int32_t, Eigen::Matrix<double, 6, 6>> held;
  for (const std::int32_t body : motions.bodies()) held[body].setZero();
  using Rows = std::map<std::int32_t, MotionVector>;
  const auto add = [&](std::int64_t dof, double coefficient, Rows& rows) {
    if (const auto row = motions.row(dof / problem.n_components(), static_cast<int>(dof % problem.n_components())))
      rows.try_emplace(row->body, MotionVector::Zero()).first->second += coefficient * row->by;
  };
  const auto constrain = [&](const Rows& rows) {
    for (const auto& [body, row] : rows) held[body] += row * row.transpose();
  };
  for (std::size_t dof = 0; dof < problem.n_dofs(); ++dof)
    if (problem.imposed[dof]) {
      Rows rows;
      add(static_cast<std::int64_t>(dof), 1, rows);
      constrain(rows);
    }
  for (const Spring& spring : problem.springs)
    for (int i = 0; i < problem.dimension; ++i) {
      if (spring.stiffness[static_cast<std::size_t>(i * (i + 1) / 2 + i)] == 0) continue;
      Rows rows;
      add(std::int64_t{spring.first} * problem.n_components() + i, 1, rows);
      if (spring.second >= 0) add(std::int64_t{spring.second} * problem.n_components() + i, -1, rows);
      constrain(rows);
    }
  for (const TimedLoad& load : problem.loads)
    for (const DofRelation& relation : load.relations) {
      Rows rows;
      for (std::size_t i = 0; i < relation.dofs.size(); ++i) add(relation.dofs[i], relation.coefficients[i], rows);
      constrain(rows);
    }
  std::set<std::int32_t> free;
  for (const auto& [body, gram] : held)
    if (motions.free_of(gram).cols() > 0) free.insert(body);
  return free;
}

}  // namespace lacon
