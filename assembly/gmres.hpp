#pragma once
// GMRES: the generalised minimal residual method, preconditioned from the right and restarted.
#include <functional>
#include <span>
#include <vector>

namespace lacon {

struct GmresOptions {
  double goal = 0;     ///< norm of the scaled residual at which it ends
  int iterations = 0;  ///< most of them, in all cycles and in one
  int cycles = 3;      ///< most starts from a residual computed anew
};

struct GmresResult {
  std::vector<double> x;
  double residual = 0;  ///< norm of the scaled residual; infinite where the numbers overflowed
  int iterations = 0;
};

/// Solve A x = b, from x = 0 on.
/// @param multiply y = A x  @param precondition x -> P^-1 x in place  @param scale of the equations, (n): residuals are
/// measured, and minimised, multiplied by it
GmresResult gmres(const std::function<void(std::span<const double> x, std::span<double> y)>& multiply,
                  const std::function<void(std::span<double> x)>& precondition, std::span<const double> scale,
                  std::span<const double> right_side, const GmresOptions& options);

}  // namespace lacon
