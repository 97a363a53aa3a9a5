#pragma once
// What derivatives by nodes are made of: rows, sums of products of rows, skins at a point.
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "lacon/elements/reference.hpp"

namespace lacon::variations {

constexpr int max_skin_nodes = 9;

template <int D>
using Vector = Eigen::Matrix<double, D, 1>;
/// Derivatives of a vector of N numbers by some variables.
template <int N>
using Rows = Eigen::Matrix<double, N, Eigen::Dynamic, Eigen::RowMajor>;
using Row = Rows<1>;
using Matrix = Rows<Eigen::Dynamic>;
/// Derivatives by the variables of integration points: slave, master, nodal normals, corners. Without memory of their own.
constexpr int max_point_variables = 256;
template <int N>
using PointRows = Eigen::Matrix<double, N, Eigen::Dynamic, Eigen::RowMajor, N, max_point_variables>;
using PointRow = PointRows<1>;

/// An unknown by itself that derivatives take for fixed, though it moves with the nodes.
struct OwnUnknown {
  double gap;  ///< dG by it
  Row place;   ///< its derivatives by the unknowns
};

/// A quadratic form of the variables as a sum of products.
class QuadraticForm {
 public:
  explicit QuadraticForm(Eigen::Index n) : sum_(Matrix::Zero(n, n)) {}
  /// Add factor * first(d) * second(d).
  template <class First, class Second>
  void add(double factor, const First& first, const Second& second) {
    if (factor == 0) return;
    if (left_.rows() == 0) left_.resize(at_once, sum_.cols()), right_.resize(at_once, sum_.cols());
    if (count_ == at_once) sum_up();
    left_.row(count_) = factor * first;
    right_.row(count_) = second;
    ++count_;
  }
  /// Add factor . (first(d) x second(d)). @param first, second (3, n)
  template <class First, class Second>
  void add_cross(const Vector<3>& factor, const First& first, const Second& second) {
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      add(factor[i], first.row(j), second.row(k));
      add(-factor[i], first.row(k), second.row(j));
    }
  }
  /// Add factor . (dx_a x dx_b), the variables being coordinates of nodes.
  void add_cross_of_nodes(const Vector<3>& factor, int a, int b) {
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      sum_(3 * a + j, 3 * b + k) += factor[i];
      sum_(3 * a + k, 3 * b + j) -= factor[i];
    }
  }
  Eigen::Index size() const { return sum_.rows(); }
  /// What is multiplied by variable i, to be added to.
  auto of(Eigen::Index i) { return sum_.row(i); }
  /// The symmetric matrix H with d.H.d of the form.
  Eigen::MatrixXd matrix();

 private:
  static constexpr Eigen::Index at_once = 64;  // products
  void sum_up();

  Matrix sum_;  ///< of products, but for those still to be summed up
  Eigen::Index count_ = 0;
  Matrix left_, right_;  ///< of these
};

/// Shape functions of a skin cell at a point, with their derivatives to an order.
template <int D>
struct Shapes {
  static constexpr int R = D - 1;
  int n, order;
  std::array<double, max_skin_nodes> value;
  std::array<double, max_skin_nodes * R> gradient;
  std::array<double, max_skin_nodes * 3> curvature;  ///< all of an order, as shape_derivatives() has them
  std::array<double, max_skin_nodes * 4> third;

  Shapes(CellType type, const double* xi) : Shapes(type, 3) {
    const std::span<const double> at(xi, static_cast<std::size_t>(R));
    shape_functions(type, at, value);
    shape_gradients(type, at, gradient);
    if (order > 1) shape_derivatives(type, at, 2, curvature);
    if (order > 2) shape_derivatives(type, at, 3, third);
  }
  double slope(int node, int i) const { return gradient[static_cast<std::size_t>(node * R + i)]; }
  double bend(int node, int i, int j) const {
    return order > 1 ? curvature[static_cast<std::size_t>(node * (R == 1 ? 1 : 3) + i + j)] : 0;
  }

 private:
  /// Orders that vanish everywhere are as good as not wanted.
  Shapes(CellType type, int wanted) {
    const catalog::CellRow& cell = catalog::cell(type);
    n = cell.n_nodes;
    order = std::min(wanted, cell.family != Family::QUAD ? cell.order : cell.order == 1 ? 2 : 3);
  }
};

/// What nodal vectors interpolate to at a point, with derivatives by the reference coordinates.
template <int D>
struct Interpolated {
  static constexpr int R = D - 1;
  Vector<D> x = Vector<D>::Zero();
  std::array<Vector<D>, R> d;
  std::array<std::array<Vector<D>, R>, R> dd;
  std::array<Vector<D>, 4> ddd;  ///< by k times eta and the rest xi

  Interpolated() = default;
  Interpolated(const Shapes<D>& shapes, const double* nodes) {
    constexpr int n_second = R == 1 ? 1 : 3, n_third = R == 1 ? 1 : 4;
    std::array<Vector<D>, n_second> second;
    d.fill(x), second.fill(x), ddd.fill(x);  // zero
    for (int a = 0; a < shapes.n; ++a) {
      const Eigen::Map<const Vector<D>> node(nodes + a * D);
      x += shapes.value[static_cast<std::size_t>(a)] * node;
      for (int i = 0; i < R; ++i) d[i] += shapes.slope(a, i) * node;
      for (int i = 0; i < n_second && shapes.order > 1; ++i)
        second[i] += shapes.curvature[static_cast<std::size_t>(a * n_second + i)] * node;
      for (int i = 0; i < n_third && shapes.order > 2; ++i)
        ddd[i] += shapes.third[static_cast<std::size_t>(a * n_third + i)] * node;
    }
    for (int i = 0; i < R; ++i)
      for (int j = 0; j < R; ++j) dd[i][j] = second[i + j];
  }
};

/// The vector at a right angle to the tangent that points out of the body.
inline Vector<2> out_of(const Vector<2>& t) { return {t[1], -t[0]}; }

/// What factor . N is to each tangent, N the area normal.
template <int D>
std::array<Vector<D>, D - 1> of_tangents(const std::array<Vector<D>, D - 1>& t, const Vector<D>& factor) {
  if constexpr (D == 2)
    return {Vector<2>(-factor[1], factor[0])};
  else
    return {t[1].cross(factor), factor.cross(t[0])};
}

/// The area normal of a skin at a point, with derivatives by the reference coordinates where only these move.
template <int D>
struct AreaNormal {
  static constexpr int R = D - 1;
  Vector<D> n;
  std::array<Vector<D>, R> d;

  explicit AreaNormal(const Interpolated<D>& skin) {
    if constexpr (D == 2) {
      n = out_of(skin.d[0]);
      d[0] = out_of(skin.dd[0][0]);
    } else {
      const auto& [t, s] = skin.d;
      n = t.cross(s);
      for (int i = 0; i < R; ++i) d[i] = skin.dd[0][i].cross(s) + t.cross(skin.dd[1][i]);
    }
  }
};

/// v x rows. @param rows (3, n)
template <class ThreeRows>
ThreeRows cross(const Vector<3>& v, const ThreeRows& rows) {
  ThreeRows product(3, rows.cols());
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    product.row(i) = v[j] * rows.row(k) - v[k] * rows.row(j);
  }
  return product;
}

/// Derivatives of the area normal by those of the tangents. @tparam RowsOfTangent (D, n)
template <int D, class RowsOfTangent>
RowsOfTangent area_normal_rows(const std::array<Vector<D>, D - 1>& t, const std::array<RowsOfTangent, D - 1>& dt) {
  RowsOfTangent rows(D, dt[0].cols());
  if constexpr (D == 2) {
    rows.row(0) = dt[0].row(1);
    rows.row(1) = -dt[0].row(0);
  } else {
    for (int i = 0; i < 3; ++i) {
      const int k = (i + 1) % 3, l = (i + 2) % 3;
      rows.row(i) = t[1][l] * dt[0].row(k) - t[1][k] * dt[0].row(l) + t[0][k] * dt[1].row(l) - t[0][l] * dt[1].row(k);
    }
  }
  return rows;
}

}  // namespace lacon::variations
