#pragma once
// What a user should know of the contact of a computation while it goes.
#include <map>

#include "lacon/operators/evolution/evolution.hpp"
#include "lacon/operators/evolution/state_fields.hpp"

namespace lacon {

class ContactNotices : public EvolutionObserver {
 public:
  explicit ContactNotices(const Present& present) : present_(present) {}

  /// EVOLUTION_6: patches that no displacement can move.
  void start(double instant) override;
  /// EVOLUTION_14: such patches inside their master.
  void accept(const SolvedInstant& solved) override;
  /// EVOLUTION_16: of each zone the patch that its master has pierced deepest.
  void end(bool completed) override;

 private:
  struct Pierced {
    double instant;
    PiercedPatch worst;
  };
  std::string first_cell(std::size_t patch) const;

  Present present_;
  std::map<std::int32_t, Pierced> pierced_;  ///< by zone
};

}  // namespace lacon
