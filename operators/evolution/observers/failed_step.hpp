#pragma once
// The last iterates of a step that is given up, for who wants to see why: a file of its own beside the index of the result,
// which names no instant (docs/structures.md, section 2).
#include <deque>
#include <filesystem>
#include <optional>
#include <vector>

#include "lacon/catalog/messages.hpp"
#include "lacon/operators/contact/contact_field.hpp"
#include "lacon/operators/evolution/evolution.hpp"
#include "lacon/operators/evolution/state_fields.hpp"
#include "lacon/structures/base.hpp"

namespace lacon {

/// In the folder of a result.
inline constexpr const char* failed_step_file = "failed_step.h5";

/// Remembers the last iterates of each step, and stores those of the one that fails for good: of its attempts those whose
/// failure is told (time_stepping.hpp). They are in the base until an
/// instant as late as theirs converges, or another step of the same result fails.
class FailedStep : public EvolutionObserver {
 public:
  /// All arguments must outlive it. @param begins, ends the last instant in equilibrium, and the last that is asked for
  FailedStep(const Order& order, const Base& base, const Present& present, double begins, double ends);

  void begin(double instant) override;
  void iterate(double instant, const IterationReport& report) override;
  void failed(double instant, const Error& error) override;
  void accept(const SolvedInstant& solved) override;
  void end(bool completed) override;
  /// Throw an error on; with advice where its load is beyond what solids bear, and where to look at iterates that are stored.
  [[noreturn]] void tell(const Error& error) const;

 private:
  struct Iterate {
    int iteration;
    double rela, maxi, changes;  ///< as in the Newton table; nan of a state that was not judged any more
    std::vector<double> displacement, unbalanced;
    std::optional<Field> contact;
    std::optional<PairedMasters> masters;
  };
  /// An attempt that has failed.
  struct Failure {
    double instant;
    Message message;
    bool tries_again;  ///< its own failure is not told where another attempt fails
    std::deque<Iterate> iterates;
  };
  /// What there is to say of a pressure that is as large as moduli are, as where its unit is not theirs.
  std::string large_load() const;
  void store() const;
  void remove();

  const Order& order_;
  const Base& base_;
  Present present_;
  std::filesystem::path file_;
  std::deque<Iterate> iterates_;    ///< of the present attempt
  double begins_;                   ///< the last instant in equilibrium
  double ends_;                     ///< the last instant that is asked for
  std::optional<Failure> failure_;  ///< since the last instant in equilibrium, the one that is told if the step is given up
  std::optional<double> there_;     ///< the instant whose iterates an earlier computation has left
  bool stored_ = false;
};

}  // namespace lacon
