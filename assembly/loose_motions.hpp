#pragma once
// Motions of bodies that a matrix does not resist. A factorisation may not see them: on fine meshes, and on those of cells of
// very different size, the last pivot of a body that nothing holds is round-off far above zero.
#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include "lacon/assembly/rigid_motions.hpp"
#include "lacon/assembly/sparse_matrix.hpp"

namespace lacon {

struct LooseMotion {
  std::int64_t dof;               ///< place in Numbering::equation of what it moves most, of each motion another one
  std::set<std::int32_t> bodies;  ///< that it moves
};

class LooseMotions {
 public:
  static constexpr double round_off = 1e-11;

  /// @param numbering must outlive it
  LooseMotions(RigidMotions motions, const Numbering& numbering);

  /// Rigid motions of all bodies together, on the initial geometry, that the matrix maps to nothing but round-off: neither
  /// contact nor relations, springs or stresses resist them.
  /// @param negligible of what the entries of a row sum up to, and of what resists most
  std::vector<LooseMotion> of(const SparseMatrix& matrix, double negligible = round_off) const;

 private:
  /// A degree of freedom that has an equation, of a body that imposed displacements do not hold.
  struct Moved {
    std::int64_t dof, equation;
    std::int32_t first, count;  ///< the motions of its body
    MotionVector by;            ///< what these move it by
    auto moves() const { return by.head(count); }
  };
  struct Left {
    std::int32_t first;
    Eigen::Matrix<double, 6, Eigen::Dynamic> motions;
  };
  template <class Use>
  void for_each_row(const Use& use) const;
  std::vector<Moved> moved() const;  ///< ascending
  /// (n_motions, n): combinations of the motions that the matrix maps to nothing.
  Eigen::MatrixXd unresisted(const SparseMatrix& matrix, const std::vector<Moved>& all, double negligible) const;
  /// Each of them with its bodies, and a degree of freedom that the others are made not to move.
  std::vector<LooseMotion> told_apart(Eigen::MatrixXd motions, const std::vector<Moved>& all) const;

  RigidMotions motions_;
  const Numbering& numbering_;
  std::map<std::int32_t, Left> left_;  ///< of bodies: the motions that imposed displacements leave them
  std::vector<std::int32_t> bodies_;   ///< of each of these motions
};

}  // namespace lacon
