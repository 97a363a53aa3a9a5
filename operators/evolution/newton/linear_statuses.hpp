#pragma once
// Statuses that satisfy all patches of one linear system: an iteration that goes on with any others leaves patches pulled, or
// sends them into their master, and the next one answers to that.
#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "lacon/assembly/saddle_point_solver.hpp"
#include "lacon/operators/contact/contact_state.hpp"
#include "lacon/operators/evolution/problem/system.hpp"

namespace lacon {

/// With the solution x0 of the system of some active patches, those that are pulled may open by s >= 0, and open ones that are
/// gone into may be pressed by p >= 0. Both change x linearly, each by a column of the inverse, so that statuses are a linear
/// complementarity problem: p >= 0, gap >= 0 and p gap = 0 for every patch, at the geometry and with the matrix of the
/// iteration. It begins with those that are wrong in x0 and takes in others that are in its solution, so that there are columns
/// of few patches beside those that change. Units: pressures in the largest one of x0, gaps in what that stands for in the rule
/// of statuses.
class LinearStatuses {
 public:
  /// All patches that may change. All arguments must outlive it. @param solution x0, (n_equations)
  /// @param step of the imposed displacements, which it comes with
  LinearStatuses(const ContactState& contact, const System& system, const Patchwise& patches, std::span<const double> solution,
                 std::span<const double> step);

  using UseColumn = std::function<void(std::span<const float>)>;
  /// Find statuses that satisfy all of them. @param most columns that may be asked for: where those of patches that are wrong
  /// in the solution of others would be more, these others alone are satisfied  @param columns calls `use` with what comes of
  /// each right side, (n_equations), in turn, or not at all
  /// @return false where there are none, none are wrong or too many
  bool find(std::size_t most, const std::function<void(const SparseSides& sides, const UseColumn& use)>& columns);
  /// Patches that have to change in x0.
  std::size_t n_wrong() const { return wanted_.size(); }
  /// Let all of these change at once. Their multipliers stay: rows of open patches lead them to zero.
  void change_all(Patchwise& patches) const;
  /// Add what opens and presses to the right side of the system.
  void add_to(std::vector<double>& right_side) const { add(z_, right_side); }
  /// What columns in single precision have left of pressures and gaps that are to be zero, as another right side of the system,
  /// (n_equations). @param solution of that right side
  std::vector<double> correction(std::span<const double> solution);
  /// Let patches have their statuses. @param[in,out] solution of that right side: multipliers of patches that opened end at
  /// zero
  void take(Patchwise& patches, std::vector<double>& solution) const;

 private:
  void note(std::span<const float> column);
  bool solve();

  struct Pair {
    std::size_t patch;
    bool opens;                           ///< it was active
    std::vector<std::int32_t> equations;  ///< of the displacements that its gap depends on, where it was not, ascending,
    std::vector<double> derivative;       ///< and how
    double start;                         ///< minus the multiplier, or the integrated gap, where x = 0
    double unit_z = 1, unit_w = 1;
  };
  Pair closing(std::size_t patch, const GapRow& row, std::span<const double> step) const;
  std::int64_t multiplier(const Pair& pair) const {
    return system_.equation(system_.multiplier(static_cast<std::int64_t>(pair.patch)));
  }
  /// The change of the pressure, or of the integrated gap, along a solution.
  template <class Number>
  double along(const Pair& pair, std::span<const Number> x) const;
  /// Either in the pair's unit.
  double w(const Pair& pair, std::span<const double> solution) const {
    return (pair.start + along(pair, solution)) / pair.unit_w;
  }
  void add(const Eigen::VectorXd& z, std::vector<double>& right_side) const;
  void add_side(const Pair& pair, SparseSides& sides) const;

  const ContactState& contact_;
  const System& system_;
  const Patchwise& patches_;
  std::vector<Pair> pairs_;           ///< all that may change
  Eigen::VectorXd first_;             ///< w of x0, (pairs)
  std::vector<Eigen::Index> wanted_;  ///< those that have to change
  std::vector<Eigen::Index> taken_;   ///< those that have columns,
  Eigen::MatrixXd matrix_;            ///< what z of each makes of w, in their units, (pairs, taken or more),
  Eigen::VectorXd z_;                 ///< and what it is, (taken)
};

}  // namespace lacon
