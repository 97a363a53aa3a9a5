#pragma once
// ENERGIE: the work of external forces, of the stresses, and of what holds and presses the bodies, instant by instant.
#include <optional>
#include <vector>

#include "lacon/operators/evolution/evolution.hpp"
#include "lacon/operators/evolution/state_fields.hpp"
#include "lacon/structures/table.hpp"

namespace lacon {

/// Works along the displacements by trapezia from the first instant on: TRAV_EXT = ENER_TOT + TRAV_LIAI.
class EnergyBalance : public EvolutionObserver {
 public:
  /// @param asked ENERGIE is given: without, there is no table
  EnergyBalance(bool asked, const Present& present);

  void start(double instant) override;
  void accept(const SolvedInstant& solved) override;
  void save(const hdf5::Group& group) const override;
  void resume(const hdf5::Group& group) override;
  /// The table PARA_CALC, nothing where it is not asked for.
  const std::optional<Table>& table() const { return table_; }

 private:
  /// Displacements and forces at nodes at an instant.
  struct Forces {
    std::vector<double> motion, external, internal;
  };
  Forces forces(double instant) const;
  void add_row(double instant);

  Present present_;
  Forces last_;
  double of_external_ = 0, of_internal_ = 0;
  std::optional<Table> table_;
};

}  // namespace lacon
