#pragma once
// Relations between displacements (LIAISON_..., DNOR): rows of the system with multipliers of their own.
#include <optional>
#include <utility>
#include <vector>

#include "lacon/operators/evolution/problem/static_problem.hpp"
#include "lacon/operators/evolution/problem/system.hpp"

namespace lacon {

/// The relations of all loads, numbered through: relation r is held by the multiplier behind those of the patches. One whose
/// that follows from others and from what is imposed has no equation: it is only checked.
class Relations {
 public:
  explicit Relations(const StaticProblem& problem);

  std::size_t size() const { return relations_.size(); }
  /// Relations that have an equation: as many negative pivots.
  std::int64_t n_constraints() const;
  /// What the multiplier of a relation is the unknown of, for System.
  std::int64_t unknown(std::size_t relation, const System& system) const;
  std::string name(std::size_t relation) const;  ///< keyword and load
  /// EVOLUTION_77: there are some without an equation.
  void tell_dependent() const;

  /// Vertices that the multipliers' rows couple.
  std::vector<Coupling> couplings() const;
  /// Add multiplier * coefficient to the forces and the sum of coefficient * displacement to the multipliers' rows.
  void assemble(std::span<const double> multipliers, std::span<const double> displacement, System& system) const;
  /// Forces of the multipliers, (n_nodes, n_components).
  std::vector<double> forces(std::span<const double> multipliers) const;
  /// What each relation is to be at an instant. @param imposed (n_nodes, n_components), StaticProblem::imposed_values
  /// Throws LOAD_6 where imposed displacements and other relations contradict it.
  std::vector<double> values(double instant, std::span<const double> imposed) const;

 private:
  struct Held {
    const TimedLoad* load;
    const DofRelation* row;
    std::optional<std::vector<std::pair<std::size_t, double>>> sum_of;  ///< others, if it is a sum of these: DependentRelation
  };
  const StaticProblem& problem_;
  std::vector<Held> relations_;
};

}  // namespace lacon
