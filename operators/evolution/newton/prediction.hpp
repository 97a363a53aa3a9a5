#pragma once
// Where an instant begins: at the last state, or where the last motion leads to.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "lacon/operators/evolution/newton/doubling.hpp"

namespace lacon::hdf5 {
class Group;
}

namespace lacon {

/// A state in equilibrium, from which others are extrapolated.
struct KnownState {
  double instant = 0;
  std::vector<double> displacement;  ///< (n_nodes, n_components)
  std::vector<double> pressure;      ///< (n_patches)
  std::vector<double> force;         ///< external ones that the instant began with; nothing of the initial state
};

/// Whether a load goes on as it went before: the sum of the products of its last change and of the next one; 0 where that is
/// their round-off, so that axes decide nothing where a motion turns by a right angle.
double goes_on(std::span<const double> before, std::span<const double> last, std::span<const double> next);

/// Extrapolates the last two states in equilibrium, in proportion to the step. Newton's method leaves an error that is the
/// square of the one it starts with. So an instant begins where the motion leads to if this would have come nearer to the state
/// that was found last than the state before it, and if what is imposed at the next instant, which is known, goes on as near.
/// Where bodies come to touch or part it may lead astray all the same: an instant that fails from there begins again, and the
/// next ones begin at the last state, twice as many with each time in a row.
class Prediction {
 public:
  /// @param imposed whether a degree of freedom is, (n_nodes, n_components)
  explicit Prediction(std::vector<std::uint8_t> imposed) : imposed_(std::move(imposed)) {}

  /// An instant is solved. @param previous the state it began with, at `start` where no instant was solved before
  /// @param led whether it began where the motion led to
  void note(double start, const KnownState& previous, KnownState solved, bool led = false);
  /// An instant has failed: the next one begins at the last state.
  void distrust() { came_near_ = false; }
  /// It had begun where the motion led to.
  void mislead();
  /// Whether iterations that began where the motion led to are better begun again. @param iterations that were made
  /// @param residual the largest unbalanced force behind them, one iteration before, and where they began
  static bool leads_astray(int iterations, double residual, double before, double at_start);
  /// The last two instants, where their states are known.
  std::optional<std::pair<double, double>> last_motion() const;
  /// Whether the last motion is known, and has led to these displacements.
  bool reaches(std::span<const double> displacement) const;
  /// Whether an instant is to begin where it leads to.
  /// @param step of imposed displacements to it, (n_nodes, n_components)  @param force external forces, as of KnownState
  bool serves(double instant, std::span<const double> displacement, std::span<const double> step,
              std::span<const double> force) const;
  /// Displacements and pressures there; the motion must be known.
  KnownState at(double instant) const;

  void save(const hdf5::Group& group) const;
  void resume(const hdf5::Group& group);

 private:
  std::vector<std::uint8_t> imposed_;
  std::vector<KnownState> known_;  ///< at most two, the last one at the end
  bool came_near_ = false;         ///< the last state would have been predicted better than by the one before it
  static constexpr std::int64_t shortest = 2;
  Doubling pause_{.next = shortest};  ///< instants that begin at the last state
};

}  // namespace lacon
