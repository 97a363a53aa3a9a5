#pragma once
// Motions of bodies that a matrix does not resist. A factorisation may not see them: on fine meshes, and on those of cells of
// very different size, the last pivot of a body that nothing holds is round-off far above zero.
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
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
  /// contact nor relations, springs or stresses resist them. Other processes that have rows are asked once, until values of
  /// theirs change.
  /// @param negligible of what the entries of a row sum up to, and of what resists most: round_off, or more
  std::vector<LooseMotion> of(const SparseMatrix& matrix, double negligible = round_off);

  /// What of() has found last has a basis (of()'s motions are combinations of it): what each of its motions moves a degree of
  /// freedom by, (n), of the size of one where it is largest.
  Eigen::VectorXd by(std::int64_t dof) const;
  /// The work of a right side along each of these motions, (n).
  Eigen::VectorXd work(std::span<const double> side) const;

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
  /// What rows of other processes make of the motions.
  struct Others {
    const RowsElsewhere* rows;
    std::int64_t version;
    std::vector<double> most;              ///< of each equation: what the entries of its row sum up to
    std::vector<std::int64_t> resisting;   ///< equations whose row makes more than round-off of them; ascending
    std::vector<MotionVector> resistance;  ///< of these
    /// Nothing for a row that makes nothing of them.
    const MotionVector* resistance_of(std::int64_t equation) const;
  };
  class Resistance;
  struct Image;
  class Images;
  /// @param takes whether a degree of freedom is one of those
  template <class Takes, class Use>
  void for_each_row(const Takes& takes, const Use& use) const;
  /// @param takes whether an equation is one of those  @param use takes a Moved, with ascending degrees of freedom
  template <class Takes, class Use>
  void for_each_moved(const Takes& takes, const Use& use) const;
  template <class Takes>
  std::vector<Moved> moved(const Takes& takes) const;
  Others asked(const RowsElsewhere& rows, std::int64_t n_equations) const;
  /// What the rows of the matrix that are here make of the motions. @param first_motion of each vertex the first
  /// motion of its body, -1: nothing moves it  @param at of each equation: its place in `all`, or -1
  void multiply(const SparseMatrix& matrix, std::span<const Moved> all, std::span<const std::int32_t> first_motion,
                std::span<const std::int32_t> at, Images& images) const;
  /// (n_motions, n): combinations of the motions that the matrix maps to nothing.
  Eigen::MatrixXd unresisted(const SparseMatrix& matrix, double negligible);
  /// Each of them with its bodies, and a degree of freedom that the others are made not to move.
  std::vector<LooseMotion> told_apart(Eigen::MatrixXd motions, const std::vector<Moved>& all) const;

  RigidMotions motions_;
  const Numbering& numbering_;
  std::map<std::int32_t, Left> left_;  ///< of bodies: the motions that imposed displacements leave them
  std::vector<std::int32_t> bodies_;   ///< of each of these motions
  std::optional<Others> others_;
  Eigen::MatrixXd found_;  ///< (n_motions, n), of of()
};

}  // namespace lacon
