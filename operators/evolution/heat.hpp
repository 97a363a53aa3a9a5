#pragma once
// Temperatures in a quasi-static computation: thermal strains and parameters of the points at an instant, and the stress by
// which laws feel them.
#include <optional>
#include <vector>

#include "lacon/operators/evolution/state.hpp"
#include "lacon/operators/evolution/static_problem.hpp"
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
  /// The same as other points have it.
  void copy(const std::vector<PointValues>& from, std::vector<PointValues>& to) const;
  /// The stress that the laws of a set start from: under other moduli it keeps its elastic strain. Of laws that know nothing of
  /// thermal strains and answer to a change of strain with isotropic elasticity, what its change does is taken off.
  /// @param from the state before, nullptr: the natural one at the reference temperature
  std::vector<double> start_of_step(std::size_t set, const PointValues& now, const StaticState* from);
  /// EVOLUTION_33: cells whose first temperature is not that of reference, for laws count changes from there on alone.
  void warn_of_start(const StaticState& state) const;

 private:
  const StaticProblem& problem_;
  std::optional<ModelPoints> points_;  ///< where there are temperatures
};

}  // namespace lacon
