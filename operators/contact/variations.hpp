#pragma once
// What derivatives by nodes are made of: rows, sums of products of rows, skins at a point.
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <span>

#include "lacon/elements/reference.hpp"

namespace lacon::variations {

constexpr int max_skin_nodes = 9;

template <int D>
using Vector = Eigen::Matrix<double, D, 1>;
/// Derivatives of a vector of N numbers by all variables: slave, master, others, normals, corners.
constexpr int max_variables = 256;
template <int N>
using Rows = Eigen::Matrix<double, N, Eigen::Dynamic, Eigen::RowMajor, N, max_variables>;
using Row = Rows<1>;

/// A quadratic form of the variables as a sum of products.
class QuadraticForm {
 public:
  /// @param expected how many products there may be
  explicit QuadraticForm(Eigen::Index n, Eigen::Index expected = 64) : n_(n) { reserve(expected); }
  /// Add factor * first(d) * second(d).
  template <class First, class Second>
  void add(double factor, const First& first, const Second& second) {
    if (factor == 0) return;
    if (count_ == left_.rows()) reserve(2 * count_ + 64);
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
  /// The symmetric matrix H with d.H.d of the form.
  Eigen::MatrixXd matrix() const;

 private:
  void reserve(Eigen::Index rows) {
    left_.conservativeResize(rows, n_);
    right_.conservativeResize(rows, n_);
  }

  Eigen::Index n_, count_ = 0;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> left_, right_;
};

/// Shape functions of a skin cell at a point, with their derivatives.
template <int D>
struct Shapes {
  static constexpr int R = D - 1;
  int n;
  std::array<double, max_skin_nodes> value;
  std::array<double, max_skin_nodes * R> gradient;
  std::array<double, max_skin_nodes * 3> curvature;  ///< all of an order, as shape_derivatives() has them
  std::array<double, max_skin_nodes * 4> third;

  Shapes(CellType type, const double* xi) : n(catalog::cell(type).n_nodes) {
    const std::span<const double> at(xi, static_cast<std::size_t>(R));
    shape_functions(type, at, value);
    shape_gradients(type, at, gradient);
    shape_derivatives(type, at, 2, curvature);
    shape_derivatives(type, at, 3, third);
  }
  double slope(int node, int i) const { return gradient[static_cast<std::size_t>(node * R + i)]; }
  double bend(int node, int i, int j) const { return curvature[static_cast<std::size_t>(node * (R == 1 ? 1 : 3) + i + j)]; }
  double twist(int node, int i, int j, int k) const {
    return third[static_cast<std::size_t>(node * (R == 1 ? 1 : 4) + i + j + k)];
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

  Interpolated(const Shapes<D>& shapes, const double* nodes) {
    for (Vector<D>& third : ddd) third.setZero();
    for (int i = 0; i < R; ++i) {
      d[i].setZero();
      for (int j = 0; j < R; ++j) dd[i][j].setZero();
    }
    for (int a = 0; a < shapes.n; ++a) {
      const Eigen::Map<const Vector<D>> node(nodes + a * D);
      x += shapes.value[static_cast<std::size_t>(a)] * node;
      for (int i = 0; i < R; ++i) {
        d[i] += shapes.slope(a, i) * node;
        for (int j = 0; j < R; ++j) dd[i][j] += shapes.bend(a, i, j) * node;
      }
      for (int k = 0; k <= 3 * (R - 1); ++k) ddd[k] += shapes.third[static_cast<std::size_t>(a * (R == 1 ? 1 : 4) + k)] * node;
    }
  }
};

/// The vector at a right angle to the tangent that points out of the body.
inline Vector<2> out_of(const Vector<2>& t) { return {t[1], -t[0]}; }

/// The area normal of a skin at a point, with derivatives by the reference coordinates where only these move.
template <int D>
struct AreaNormal {
  static constexpr int R = D - 1;
  Vector<D> n;
  std::array<Vector<D>, R> d;
  std::array<std::array<Vector<D>, R>, R> dd;

  explicit AreaNormal(const Interpolated<D>& skin) {
    if constexpr (D == 2) {
      n = out_of(skin.d[0]);
      d[0] = out_of(skin.dd[0][0]);
      dd[0][0] = out_of(skin.ddd[0]);
    } else {
      const auto& [t, s] = skin.d;
      n = t.cross(s);
      for (int i = 0; i < R; ++i) d[i] = skin.dd[0][i].cross(s) + t.cross(skin.dd[1][i]);
      for (int i = 0; i < R; ++i)
        for (int j = 0; j < R; ++j)
          dd[i][j] = skin.dd[0][i].cross(skin.dd[1][j]) + skin.dd[0][j].cross(skin.dd[1][i]) + skin.ddd[i + j].cross(s) +
                     t.cross(skin.ddd[i + j + 1]);
    }
  }
};

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
