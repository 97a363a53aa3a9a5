#pragma once
// Whether iterations will come to their end in time: those that will not need not go on. For GMRES and its like, whose
// residuals never grow within a cycle; those of BiCGStab jump, those of MINRES stand for long.
#include <cmath>
#include <cstddef>
#include <vector>

namespace lacon {

class Pace {
 public:
  /// Iterations whose residuals say how fast they fall: a cycle of GMRES, which begins anew with each. The first ones are
  /// slower or faster than all others.
  static constexpr int window = 60, least = 3 * window;
  /// Of the iterations that there may be, before it is said that they are not enough: they may become faster yet.
  static constexpr double margin = 1.2;

  /// @param most iterations  @param goal residual, of the first one
  Pace(int most, double goal) : most_(most), goal_(goal) {}

  /// @param done iterations, one more with each call or as many again  @param residual behind them
  /// @return whether the goal is out of reach
  bool is_too_slow(int done, double residual) {
    residuals_.resize(static_cast<std::size_t>(done) + 1, residual);
    if (done < least) return false;
    const double fall = std::log(residuals_[static_cast<std::size_t>(done - window)] / residual) / window;
    const double left = std::log(residual / (goal_ * residuals_.front()));
    return !(fall > 0) || done + left / fall > margin * most_;
  }

 private:
  int most_;
  double goal_;
  std::vector<double> residuals_;
};

}  // namespace lacon
