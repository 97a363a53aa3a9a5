#pragma once
// The loads that EXCIT names, at any instant.
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lacon/assembly/element_sets.hpp"
#include "lacon/operators/fields/timed_values.hpp"
#include "lacon/structures/base.hpp"

namespace lacon {

struct StaticProblem;

/// Cells under a load, with its values at their integration points.
struct LoadedCells {
  ElementSet set;
  TimedValues values;  ///< (cells, n_points, n_load_values)
};

/// The sum of coefficient * displacement is given; it has a multiplier.
struct DofRelation {
  std::string source;
  std::vector<std::int64_t> dofs;
  std::vector<double> coefficients;
};

/// A load and the function of time that multiplies all of it.
struct TimedLoad {
  std::string label;
  std::optional<StudyFunction> function;
  std::vector<LoadedCells> cells;        ///< dead: on the initial geometry
  std::vector<LoadedCells> following;    ///< pressures on the current geometry (TYPE_CHARGE='SUIV')
  std::vector<std::int64_t> nodal_dofs;  ///< forces on nodes: node * n_components + component
  TimedValues nodal;                     ///< of `nodal_dofs`
  std::vector<std::int64_t> dofs;        ///< imposed displacements and other unknowns
  TimedValues values;                    ///< of `dofs`
  std::vector<DofRelation> relations;
  TimedValues relation_values;
  std::optional<std::vector<double>> steady;  ///< the dead forces at multiplier 1, (n_nodes, n_components), unless they vary

  double multiplier(double instant) const { return function ? function->value("INST", instant) : 1.0; }
  /// Dead forces at multiplier 1, (n_nodes, n_components).
  std::vector<double> force(const StaticProblem& problem, double instant) const;
};

/// The load of one occurrence of EXCIT. `problem` has its mesh, model, elements and materials already.
/// @param path of the occurrence in messages, "EXCIT[2]/"
TimedLoad read_load(const StaticProblem& problem, const Base& base, const ResultLoad& excit, const std::string& path);

/// A pressure, and a cell that it acts on.
struct Pressure {
  double value = 0;
  std::int32_t cell = -1;  ///< none
};
/// The largest one of all loads at an instant.
Pressure largest_pressure(const StaticProblem& problem, double instant);

}  // namespace lacon
