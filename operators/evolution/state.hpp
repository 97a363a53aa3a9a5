#pragma once
// What changes from instant to instant: unknowns, and what the integration points hold.
#include <span>
#include <vector>

#include "lacon/assembly/parts/kept_points.hpp"
#include "lacon/operators/contact/contact_state.hpp"

namespace lacon {

/// What the integration points of a solid set hold.
struct PointValues {
  std::vector<double> stress;    ///< (cells, points, components)
  std::vector<double> variable;  ///< (cells, points, internal variables)
  // what temperatures do; empty where there are none
  std::vector<double> thermal;       ///< (cells, points): thermal strain
  std::vector<double> parameter;     ///< (cells, parameters), where parameters follow the temperature
  std::vector<double> initial = {};  ///< (cells, points, 6): initial strains, empty without any
};

/// All unknowns at an instant, and what laws with a memory remember.
struct StaticState {
  std::vector<double> displacement;  ///< (n_nodes, n_components), with the other unknowns of each node behind it
  Patchwise patches;
  std::vector<double> relations;              ///< multipliers of the loads' relations
  std::vector<PointValues> points;            ///< of each solid set; empty where `kept` is there
  std::vector<std::size_t> kept_covers = {};  ///< patches whose cover another computation has kept, to begin with
  KeptState kept = {};                        ///< the same, where the processes of PETSc have the cells

  std::size_t n_sets() const { return kept ? kept->n_sets() : points.size(); }
};

/// Values of a solid set, wherever they are. @param room for those that have to be fetched
inline std::span<const double> values_of(const StaticState& state, std::size_t set, PointQuantity quantity,
                                         std::vector<double>& room) {
  if (!state.kept) return quantity == PointQuantity::stress ? state.points[set].stress : state.points[set].variable;
  return room = state.kept->values(set, quantity);
}

}  // namespace lacon
