#pragma once
// Initial strains (PRE_EPSI) in a quasi-static computation, and the stress by which laws feel them.
#include <vector>

#include "lacon/operators/evolution/state.hpp"
#include "lacon/operators/evolution/static_problem.hpp"

namespace lacon {

/// Throws BEHAVIOUR_6 for a law that does not start elastically, on cells that have initial strains.
void check_laws(const Registry& registry, const InitialStrains& strains, const std::vector<ElementSet>& solids);

/// Refers to the problem, which must outlive it.
class Prestrain {
 public:
  explicit Prestrain(const StaticProblem& problem) : problem_(problem) {}

  /// Set the initial strains of the points of each solid set at an instant.
  void move_to(double instant, std::vector<PointValues>& points) const;
  /// The same as other points have it.
  void copy(const std::vector<PointValues>& from, std::vector<PointValues>& to) const;
  /// Whether loads have initial strains, or a state was found under some.
  bool acts(const StaticState& state) const;
  /// Whether points have them, or had them. @param before of the state before,
  /// nullptr: of the natural one, without initial strains
  static bool acts(const PointValues& now, const PointValues* before) {
    return !now.initial.empty() || (before && !before->initial.empty());
  }
  /// Take what their change does off the stress that the laws of a set start from.
  void take_off(std::size_t set, const PointValues& now, const PointValues* before, std::vector<double>& stress) const;

 private:
  const StaticProblem& problem_;
};

}  // namespace lacon
