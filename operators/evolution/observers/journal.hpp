#pragma once
// The journal of a computation: a line of JSON for each iteration, in the folder of the result as it is computed, for who looks
// on from outside (docs/structures.md, section 2).
#include <chrono>
#include <filesystem>
#include <fstream>

#include "lacon/operators/evolution/evolution.hpp"
#include "lacon/operators/evolution/state_fields.hpp"

namespace lacon {

/// Writes lines behind those of earlier processes that have computed the same result. What cannot be written is left out: a
/// computation does not end for its journal.
class Journal : public EvolutionObserver {
 public:
  /// @param result folder of the result, in which the archive puts the index  @param begins the instant of the state it starts
  /// from
  Journal(const std::filesystem::path& result, const TimeSteps& steps, double begins, const ConvergenceCriteria& criteria,
          const Present& present);

  void begin(double instant) override;
  void iterate(double instant, const IterationReport& report) override;
  void accept(const SolvedInstant& solved) override;
  /// A journal of a computation that leaves neither result nor iterates of a failed step goes.
  void end(bool completed) override;

 private:
  double seconds() const;

  std::filesystem::path folder_;
  Present present_;
  std::ofstream out_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace lacon
