#pragma once
// The end of a computation that a signal asks for: between two iterations, or behind an instant that is stored.
#include "lacon/operators/evolution/evolution.hpp"

namespace lacon {

/// The last of the observers: what the others do with an instant is done. Throws EVOLUTION_30, which no cut helps.
class Interruption : public EvolutionObserver {
 public:
  void iterate(double instant, const IterationReport& report) override;
  void accept(const SolvedInstant& solved) override;
};

}  // namespace lacon
