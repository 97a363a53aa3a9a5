#pragma once
// Statuses that satisfy all patches of one linear system: an iteration that goes on with any others leaves patches pulled, or
// sends them into their master, and the next one answers to that.
#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "lacon/assembly/saddle_point_solver.hpp"
#include "lacon/operators/contact/contact_state.hpp"
#include "lacon/operators/evolution/system.hpp"

namespace lacon {

/// With the solution x0 of the system of some active patches, those that are pulled may open by s >= 0, and open ones that are
/// gone into may be pressed by p >= 0. Both change x linearly, each by a column of the inverse, so that statuses are a linear
/// complementarity problem: p >= 0, gap >= 0 and p gap = 0 for every patch, at the geometry and with the matrix of the
/// iteration. Units: pressures in the largest one of x0, gaps in what that stands for in the rule of statuses.
class LinearStatuses {
 public:
  /// All patches that may change. All arguments must outlive it. @param solution x0, (n_equations)
  /// @param step of the imposed displacements, which it comes with
  LinearStatuses(const ContactState& contact, const System& system, const Patchwise& patches, std::span<const double> solution,
                 std::span<const double> step);

  /// Whether none of them has to.
  bool satisfied() const { return wrong_.empty(); }
  /// Look at so many patches at most, those that have to change and what is nearest around them.
  /// @return false where these alone are more
  bool narrow(std::size_t most);
  std::size_t size() const { return pairs_.size(); }
  /// Right sides of some of the columns.
  SparseSides sides(std::size_t first, std::size_t last) const;
  /// What came of them. @param columns (last - first, n_equations)
  void note(std::size_t first, std::size_t last, std::span<const float> columns);
  /// All columns have come. @return whether there are such statuses
  bool solve();
  /// Add what opens and presses to the right side of the system.
  void add_to(std::vector<double>& right_side) const { add(z_, right_side); }
  /// What columns in single precision have left of pressures and gaps that are to be zero, as another right side of the system,
  /// (n_equations). @param solution of that right side
  std::vector<double> correction(std::span<const double> solution);
  /// Let patches have their statuses. @param[in,out] solution of that right side: multipliers of patches that opened end at
  /// zero
  void take(Patchwise& patches, std::vector<double>& solution) const;

 private:
  struct Pair {
    std::size_t patch;
    bool opens;    ///< it was active
    GapRow row;    ///< of one that was not
    double start;  ///< minus the multiplier, or the integrated gap, where x = 0
    double unit_z, unit_w;
  };
  /// The pressure, or the integrated gap, of a solution.
  double w(const Pair& pair, std::span<const double> solution) const {
    return pair.start + (pair.opens ? -solution[static_cast<std::size_t>(multiplier(pair.patch))] : along(pair.row, solution));
  }
  void add(const Eigen::VectorXd& z, std::vector<double>& right_side) const;
  std::int64_t multiplier(std::size_t patch) const {
    return system_.equation(system_.multiplier(static_cast<std::int64_t>(patch)));
  }
  /// Equation of an unknown of a row, or -1.
  std::int64_t equation(const ContactUnknown& unknown) const {
    return system_.equation(system_.unknown(unknown.vertex, unknown.component));
  }
  /// The change of a row's gap along displacements of the equations.
  template <class Number>
  double along(const GapRow& row, std::span<const Number> x) const;

  const ContactState& contact_;
  const System& system_;
  const Patchwise& patches_;
  std::span<const double> first_;  ///< x0
  std::vector<Pair> pairs_;
  std::vector<std::size_t> wrong_;  ///< places of those that have to change
  Eigen::MatrixXd matrix_;          ///< what z makes of w, in their units
  Eigen::VectorXd z_;               ///< likewise
};

}  // namespace lacon
