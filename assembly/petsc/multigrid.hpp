#pragma once
// Multigrid of displacements by smoothed aggregation, which outlives the matrix that it was made for: to make it takes as long
// as some iterations, and matrices of one study are like each other. Of another matrix its finest level has the entries, the
// coarser ones what they had.
#include <petscksp.h>

#include <cstdint>
#include <vector>

#include "lacon/assembly/petsc/near_null_space.hpp"
#include "lacon/assembly/petsc/owned.hpp"

namespace lacon {

class Multigrid {
 public:
  /// Whether it will do for another matrix of these nodes, wherever they have moved: on all processes, or on none.
  bool suits(const OwnNodes& nodes) const;
  /// Have a KSP precondition with it whose matrix is in blocks of double precision.
  void give_to(KSP displacements);
  /// Make one for such a KSP. Its levels are in single precision.
  void make(KSP displacements, const OwnNodes& nodes);
  /// Of the matrix that it works for nothing is needed any more.
  void let_go() const;
  void forget() { *this = {}; }

  /// Whether it works for another matrix than it was made for.
  bool is_kept() const { return pc_ && !is_new_; }
  /// Whether so many iterations were lost by that that a new one pays.
  bool is_old() const;
  /// Iterations after which it is said to be of no use for a matrix that it was not made for.
  int most_iterations(double digits) const;
  /// How many it has taken for so many digits.
  void note(int iterations, double digits);

 private:
  Mat finest() const;

  OwnedPc pc_;
  std::vector<std::uint8_t> is_free_;
  bool is_new_ = false;
  double of_a_digit_ = 0;  ///< iterations, with the matrix that it was made for
  double lost_ = 0;        ///< iterations more than these, with all others
};

}  // namespace lacon
