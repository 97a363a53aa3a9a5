#pragma once
// Temperatures in a quasi-static computation: thermal strains and parameters of the points at an instant.
#include <optional>
#include <vector>

#include "lacon/operators/evolution/problem/state.hpp"
#include "lacon/operators/evolution/problem/static_problem.hpp"
#include "lacon/operators/fields/cell_points.hpp"

namespace lacon {

/// Refers to the problem, which must outlive it.
class Heat {
 public:
  explicit Heat(const StaticProblem& problem);

  /// Whether there are temperatures, and whether they change the stiffness.
  bool acts() const { return problem_.thermal != nullptr; }
  bool changes_stiffness() const;
  /// Set what temperatures do to the points of each solid set at an instant.
  void move_to(double instant, std::vector<PointValues>& points);
  /// EVOLUTION_33: cells whose first temperature is not that of reference, for laws count changes from there on alone.
  void warn_of_start(const StaticState& state) const;

 private:
  const StaticProblem& problem_;
  std::optional<ModelPoints> points_;  ///< where there are temperatures
};

}  // namespace lacon
