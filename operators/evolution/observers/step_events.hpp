#pragma once
// The events by which a step counts as failed although its iterations might go on or have converged (DEFI_LIST_INST, ECHEC).
#include <array>
#include <optional>
#include <vector>

#include "lacon/operators/evolution/evolution.hpp"
#include "lacon/operators/evolution/observers/observation.hpp"

namespace lacon {

class StepEvents : public EvolutionObserver {
 public:
  /// @param fields of the present instant
  StepEvents(const std::vector<StepEvent>& events, const Base& base, const Mesh& mesh, FieldMakers fields);

  void start(double instant) override;
  void begin(double instant) override;
  /// Throws STEP_1 (RESI_MAXI: a residual above the limit), STEP_4 (DIVE_RESI: two that have not fallen), severity S.
  void iterate(double instant, const IterationReport& report) override;
  /// Throws STEP_2 (DELTA_GRANDEUR) where a component has changed by more than VALE_REF since the last accepted instant.
  void judge(double instant) override;
  void accept(const SolvedInstant& solved) override;
  void resume(const hdf5::Group& group) override;

 private:
  struct IncrementLimit {
    double limit;
    Observer observer;
    std::vector<Observer::Value> last;
  };
  void remember();

  FieldMakers fields_;
  std::vector<IncrementLimit> increments_;
  std::optional<double> largest_residual_;
  bool may_diverge_ = true;
  std::array<double, 2> before_{};  ///< residuals of the last iterations, the latest first
};

}  // namespace lacon
