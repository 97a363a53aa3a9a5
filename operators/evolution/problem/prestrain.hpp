#pragma once
// Initial strains (PRE_EPSI) in a quasi-static computation.
#include <vector>

#include "lacon/operators/evolution/problem/state.hpp"
#include "lacon/operators/evolution/problem/static_problem.hpp"

namespace lacon {

/// Throws BEHAVIOUR_6 for a law that does not start elastically, on cells that have initial strains.
void check_laws(const Registry& registry, const InitialStrains& strains, const std::vector<ElementSet>& solids);

/// Refers to the problem, which must outlive it.
class Prestrain {
 public:
  explicit Prestrain(const StaticProblem& problem) : problem_(problem) {}

  /// Set the initial strains of the points of each solid set at an instant.
  void move_to(double instant, std::vector<PointValues>& points) const;
  /// Whether loads have initial strains, or a state was found under some.
  bool acts(const StaticState& state) const;

 private:
  const StaticProblem& problem_;
};

}  // namespace lacon
