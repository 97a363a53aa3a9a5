#pragma once
// Strains that follow from the right Cauchy-Green tensor C = F^T F alone: E = sum e(c_i) N_i (x) N_i, c_i the eigenvalues of
// C - I and N_i their directions. A law says the stress T that works on E; it is taken back to S, which works on C / 2, and the
// derivative of S follows from first and second divided differences of e (Miehe, Apel, Lambrecht, Comput. Methods Appl. Mech.
// Engrg. 2002, with the derivatives of Daleckii and Krein).
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace lacon::solid {

using Matrix3 = Eigen::Matrix3d;
using Matrix9 = Eigen::Matrix<double, 9, 9>;  ///< row and column 3 i + k stand for the component (i, k)

/// GDEF_LOG: e(c) = ln(1 + c) / 2.
struct LogarithmicMeasure {
  static double strain(double c) { return std::log1p(c) / 2; }
  static double first(double a, double b) {
    const double r = (a - b) / (1 + b);
    return r == 0 ? 0.5 / (1 + b) : std::log1p(r) / (2 * r * (1 + b));
  }
  static double second(double a, double b, double c) {
    constexpr double near = 0.02;  // closer than that a series loses less than the difference of differences
    const double low = std::min({a, b, c}), high = std::max({a, b, c}), middle = a + b + c - low - high;
    const double centre = 1 + (a + b + c) / 3;
    if (high - low > near * centre) return (first(high, middle) - first(middle, low)) / (high - low);
    // sum over k of e^(k+2) / (k+2)! times the complete symmetric polynomial h_k of the distances from the centre
    const double x = (1 + a) / centre - 1, y = (1 + b) / centre - 1, z = (1 + c) / centre - 1;
    const double pairs = x * y + y * z + z * x, triple = x * y * z;
    double before[3] = {0, 0, 1}, sum = 0;  // h_{k-2}, h_{k-1}, h_k; h_1 vanishes
    for (int k = 0; k < 9; ++k) {
      sum += (k % 2 ? 0.5 : -0.5) / (k + 2) * before[2];
      const double next = -pairs * before[1] + triple * before[0];
      before[0] = before[1];
      before[1] = before[2];
      before[2] = next;
    }
    return sum / (centre * centre);
  }
};

/// GROT_GDEP: Green and Lagrange's strain, e(c) = c / 2.
struct GreenMeasure {
  static double strain(double c) { return c / 2; }
  static double first(double, double) { return 0.5; }
  static double second(double, double, double) { return 0; }
};

/// A deformation gradient in the directions of C.
template <class M>
class Deformation {
 public:
  /// @param slope gradient H of the displacement, F = I + H
  explicit Deformation(const Matrix3& slope) : f_(Matrix3::Identity() + slope) {
    const Matrix3 stretch = slope + slope.transpose() + slope.transpose() * slope;  // C - I, exact for small slopes
    const Eigen::SelfAdjointEigenSolver<Matrix3> solver(stretch);
    c_ = solver.eigenvalues();
    axes_ = solver.eigenvectors();
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) first_(i, k) = M::first(c_[i], c_[k]);
  }
  double volume() const { return f_.determinant(); }
  Matrix3 strain() const {
    return axes_ * Eigen::Vector3d(M::strain(c_[0]), M::strain(c_[1]), M::strain(c_[2])).asDiagonal() * axes_.transpose();
  }
  /// T out of Cauchy's stress.
  Matrix3 working(const Matrix3& cauchy) const {
    const Matrix3 back = axes_.transpose() * f_.inverse(), s = volume() * back * cauchy * back.transpose();
    return axes_ * s.cwiseQuotient(2 * first_) * axes_.transpose();
  }
  /// S out of T.
  Matrix3 second_piola(const Matrix3& working) const {
    return axes_ * (2 * first_).cwiseProduct(axes_.transpose() * working * axes_) * axes_.transpose();
  }
  const Matrix3& gradient() const { return f_; }

  /// dP / dF of P = F S where T answers to E by lambda tr(dE) I + 2 mu dE - rank (direction : dE) direction.
  /// @param working T; zero leaves out what present stresses do when they turn and move
  Matrix9 tangent(double lambda, double mu, double rank, const Matrix3& direction, const Matrix3& working) const {
    const Matrix3 t = axes_.transpose() * working * axes_, d = axes_.transpose() * direction * axes_;
    double second[3][3][3];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        for (int k = 0; k < 3; ++k) second[i][j][k] = M::second(c_[i], c_[j], c_[k]);
    Matrix9 answer;  // dS by Green and Lagrange's strain
    for (int m = 0; m < 3; ++m)
      for (int j = 0; j < 3; ++j)
        for (int n = 0; n < 3; ++n)
          for (int l = 0; l < 3; ++l) {
            double value = -4 * rank * first_(m, j) * first_(n, l) * d(m, j) * d(n, l);
            if (m == j && n == l) value += 4 * lambda * first_(m, m) * first_(n, n);
            const double square = 4 * mu * first_(m, j) * first_(m, j);
            if (m == n && j == l) value += square;
            if (m == l && j == n) value += square;
            if (j == l) value += 2 * second[m][j][n] * t(m, n);
            if (j == n) value += 2 * second[m][j][l] * t(m, l);
            if (m == l) value += 2 * second[m][j][n] * t(j, n);
            if (m == n) value += 2 * second[m][j][l] * t(j, l);
            answer(3 * m + j, 3 * n + l) = value;
          }
    Matrix9 turned;  // F N and N, pair by pair
    const Matrix3 forward = f_ * axes_;
    for (int i = 0; i < 3; ++i)
      for (int a = 0; a < 3; ++a)
        for (int m = 0; m < 3; ++m)
          for (int j = 0; j < 3; ++j) turned(3 * i + a, 3 * m + j) = forward(i, m) * axes_(a, j);
    Matrix9 whole = turned * answer * turned.transpose();
    const Matrix3 s = second_piola(working);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        for (int l = 0; l < 3; ++l) whole(3 * i + j, 3 * i + l) += s(j, l);
    return whole;
  }

 private:
  Matrix3 f_, axes_, first_;
  Eigen::Vector3d c_;
};

}  // namespace lacon::solid
