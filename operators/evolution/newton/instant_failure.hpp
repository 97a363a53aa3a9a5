#pragma once
// What a driver should know of an instant that failed, to judge whether a shorter step may help.
#include <optional>
#include <utility>

#include "lacon/catalog/messages.hpp"

namespace lacon {

struct FailureNature {
  bool depends_on_step = true;  ///< false: a shorter step meets the same
  /// By which factor the residual changed at last from iteration to iteration, where nothing but it was unsettled.
  std::optional<double> ratio;
  double excess = 0;  ///< the residual over what is asked
  /// Of these at most one: the instant is worth another attempt, before anything is cut.
  bool led_astray = false;       ///< it began where the last motion leads to: the last state may be a better start
  bool left_unstable = false;    ///< iterations left the equilibrium that the last one leads to: the next attempt follows it
  bool stayed_unstable = false;  ///< it followed that equilibrium: the next attempt looks for another one
  bool begins_again() const { return led_astray || left_unstable || stayed_unstable; }
};

/// Thrown for a failure of which more is known than its message.
class InstantFailure : public Error {
 public:
  InstantFailure(Message message, FailureNature nature) : Error(std::move(message)), nature_(nature) {}
  const FailureNature& nature() const { return nature_; }

 private:
  FailureNature nature_;
};

/// What is known of a failure; of some nothing but their message.
inline FailureNature nature_of(const Error& error) {
  const auto* const known = dynamic_cast<const InstantFailure*>(&error);
  return known ? known->nature() : FailureNature{};
}

/// Whether the machine has failed, not the step: memory, a full disk, processes that were killed. No other attempt at it is to
/// hide that.
inline bool is_of_the_machine(const Message& message) {
  return message.id == "SOLVER_2" || message.id == "SOLVER_5" || message.id == "SOLVER_8";
}

}  // namespace lacon
