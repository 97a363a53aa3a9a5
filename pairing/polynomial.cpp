#include "lacon/pairing/polynomial.hpp"

#include <algorithm>
#include <cmath>

namespace lacon {
namespace {

/// The zero between a and b, where p has different signs and is monotone.
double zero_between(const Polynomial& p, double a, double b, bool positive_at_a) {
  if (p.degree == 1) return std::clamp(-p.c[0] / p.c[1], a, b);
  const Polynomial slope = p.derivative();
  double x = 0.5 * (a + b);
  for (int iteration = 0; iteration < 100; ++iteration) {
    const double value = p(x);
    if (value == 0) return x;
    if ((value >= 0) == positive_at_a)
      a = x;
    else
      b = x;
    const double step = x - value / slope(x);
    const double next = step > a && step < b ? step : 0.5 * (a + b);  // also where the slope is 0 or the step not finite
    if (next == x || next <= a || next >= b) return next;
    if (std::abs(next - x) <= 1e-17) return next;
    x = next;
  }
  return x;
}

}  // namespace

Polynomial Polynomial::derivative() const {
  Polynomial d;
  d.degree = std::max(0, degree - 1);
  for (int k = 1; k <= degree; ++k) d.c[k - 1] = k * c[k];
  return d;
}

SignChanges sign_changes(const Polynomial& p) {
  SignChanges found;
  double a = -1;
  bool positive = p(a) >= 0;
  found.positive = positive;
  if (p.degree == 0) return found;
  const auto piece = [&](double b) {
    const bool positive_at_b = p(b) >= 0;
    if (positive_at_b != positive && found.n < Polynomial::max_degree) found.at[found.n++] = zero_between(p, a, b, positive);
    positive = positive_at_b;
    a = b;
  };
  if (p.degree > 1) {
    const SignChanges turning = sign_changes(p.derivative());
    for (int i = 0; i < turning.n; ++i) piece(turning.at[i]);
  }
  piece(1);
  return found;
}

double minimum(const Polynomial& p) {
  double smallest = std::min(p(-1), p(1));
  const SignChanges turning = sign_changes(p.derivative());
  for (int i = 0; i < turning.n; ++i) smallest = std::min(smallest, p(turning.at[i]));
  return smallest;
}

}  // namespace lacon
