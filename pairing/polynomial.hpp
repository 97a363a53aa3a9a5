#pragma once
// Polynomials of low degree on [-1, 1]: where they change sign.
#include <array>

namespace lacon {

/// sum of c[k] x^k for k up to `degree`.
struct Polynomial {
  static constexpr int max_degree = 4;
  int degree = 0;
  std::array<double, max_degree + 1> c{};

  double operator()(double x) const {
    double value = c[degree];
    for (int k = degree - 1; k >= 0; --k) value = value * x + c[k];
    return value;
  }
  Polynomial derivative() const;
};

/// The points where a polynomial changes sign on [-1, 1], zero counting as positive; in ascending order.
struct SignChanges {
  bool positive = true;  ///< at -1
  int n = 0;
  std::array<double, Polynomial::max_degree> at{};
};

/// All sign changes, to round-off: between two turning points the polynomial is monotone, and Newton's method that is kept
/// inside a bracket cannot miss. Works for leading coefficients of any size, zero included.
SignChanges sign_changes(const Polynomial& p);

/// The smallest value on [-1, 1].
double minimum(const Polynomial& p);

}  // namespace lacon
