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
#include "lacon/operators/program/study_function.hpp"
#include "lacon/structures/base.hpp"

namespace lacon {

struct StaticProblem;

/// Numbers, some of which are functions of a point (X, Y, Z on the initial geometry) and of time (INST).
class TimedValues {
 public:
  explicit TimedValues(std::size_t n = 0) : values_(n, 0.0) {}

  void set(std::size_t i, double value) { values_[i] = value; }
  /// @param point (3)
  void set(std::size_t i, std::shared_ptr<const StudyFunction> function, std::span<const double> point);
  /// Evaluate what does not depend on time, once and for all.
  void settle();
  bool depends_on_time() const { return !parts_.empty(); }
  std::size_t size() const { return values_.size(); }
  /// Throws FUNCTION_1, FORMULE_2 where a function has no value.
  std::vector<double> at(double instant) const;

 private:
  /// The values of one function.
  struct Part {
    std::shared_ptr<const StudyFunction> function;
    std::vector<std::size_t> index;
    std::vector<double> x, y, z;
  };
  static void evaluate(const Part& part, double instant, std::vector<double>& values);

  std::vector<double> values_;
  std::vector<Part> parts_;
};

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

}  // namespace lacon
