#pragma once
// What changes from instant to instant: unknowns, and what the integration points hold.
#include <span>
#include <vector>

#include "lacon/assembly/parts/kept_points.hpp"
#include "lacon/operators/contact/contact_state.hpp"

namespace lacon {

/// All unknowns at an instant, and what laws with a memory remember.
struct StaticState {
  std::vector<double> displacement;  ///< (n_nodes, n_components), with the other unknowns of each node behind it
  Patchwise patches;
  std::vector<double> relations;              ///< multipliers of the loads' relations
  std::vector<PointValues> points;            ///< of each solid set; empty where `kept` is there
  KeptState kept = {};                        ///< the same, where other processes have the cells
  std::vector<std::size_t> kept_covers = {};  ///< patches whose cover another computation has kept, to begin with
  KeptPairing kept_pairing = {};              ///< likewise

  std::size_t n_sets() const { return kept ? kept->n_sets() : points.size(); }
};

/// Whether the points of a solid set hold a quantity.
inline bool holds(const StaticState& state, std::size_t set, PointQuantity quantity) {
  return state.kept ? state.kept->holds(set, quantity) : !(state.points[set].*member_of(quantity)).empty();
}
/// Values of a solid set, wherever they are; empty where its points hold none. @param room for those that have to be fetched
inline std::span<const double> values_of(const StaticState& state, std::size_t set, PointQuantity quantity,
                                         std::vector<double>& room) {
  if (!state.kept) return state.points[set].*member_of(quantity);
  return room = state.kept->holds(set, quantity) ? state.kept->values(set, quantity) : std::vector<double>();
}

}  // namespace lacon
