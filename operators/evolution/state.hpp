#pragma once
// What changes from instant to instant: unknowns, and what the integration points hold.
#include <vector>

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
  std::vector<double> relations;    ///< multipliers of the loads' relations
  std::vector<PointValues> points;  ///< of each solid set
};

}  // namespace lacon
