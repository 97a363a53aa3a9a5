#pragma once
// What the integration points of a contact cell add to the derivatives of its integrated gap, LACON_LANES points at a time.
#include <array>
#include <vector>

#include "lacon/operators/contact/variation/gap_variation.hpp"
#include "lacon/operators/contact/variation/lane_vectors.hpp"

// The variables of points: slave, master, nodal normals, and the corners of the simplex in the slave's chart, which in the end
// are themselves functions of all unknowns. At a point the integrand is
//     h = k c,   k = J r / (A . m),   c = g - o(xi),   y(eta) = x(xi) + g n(xi),
// J the measure, r the radius (1 but in axisymmetry), A the area normal, m the mean normal of a plane chart (A . m is 1
// elsewhere), o the offset of the skins, n the direction of N, which is A or interpolates nodal normals. With the multiplier k
// a of the last equation, a . y_i = 0 and a . n = 1,
//     dh  = c dk + k a . (dy - dx - g dn) - k do                                       at fixed eta,
//     d2h = c d2k + 2 dk (dg - do) + k a . (d2y - d2x - 2 dg dn - g d2n) - k d2o       where eta moves, but for d2eta,
//     dg = a . R,   d eta^i = -b^i . R,   R = dy - dx - g dn,   b^i . y_j = 1 if i = j, b^i . n = 0.
// Of a direction, d2n = (d2N - n (n . d2N)) / L - n |dn|^2 - 2 dn dL / L, and |N| has d2L = n . d2N + L |dn|^2.
//
// All of that is a quadratic form of a dozen quantities that move at a point: dy - dx, dA, dN, a . dy_i, dxi (Local). Only
// that form is taken to the nodes, row by row: it is sum over nodes of (a number) x (D rows by the nodes), so that all points
// together are a product of two matrices (PointProducts). Reference coordinates hang on the corners,
//     dxi = sum over corners of share * sides dcorner,
// and in a plane chart on the slave's nodes besides: c . (x(xi) - y) = 0, y the place in the plane.

namespace lacon::variations {

constexpr int max_slave_nodes = 9;

/// Sums over points of left (n) times right (m): the points wait until they are worth a product of matrices.
class PointProducts {
 public:
  void start(int lefts, int rights);
  /// Room for more: at most `pieces_at_once` pieces of LACON_LANES points at a time. The sum may be looked at after flush().
  void make_room() {
    if (count_ + pieces_at_once * LACON_LANES > room) flush();
  }
  void flush();
  /// Of the next piece.
  LACON_INLINE Lanes& left(int i) { return lanes(left_.data() + i * room + count_, 0); }
  /// The right sides of the next piece, `room` doubles from one to the next.
  LACON_INLINE double* right() { return right_.data() + count_; }
  LACON_INLINE void next() { count_ += LACON_LANES; }
  /// (lefts, rights)
  const double* sum() const { return sum_.data(); }

  static constexpr int pieces_at_once = 4;
  static constexpr int room = 9 * LACON_LANES;  ///< points; an odd number of cache lines

 private:
  int lefts_ = 0, rights_ = 0, count_ = 0;
  std::vector<double> left_, right_, sum_;
};

/// The mean plane of a slave with straight edges as its chart: along two directions c whose cross product is its mean normal,
/// with a triangle of the slave's chart in it. Sums over the nodes make c, e and its origin.
struct PlaneOfSlave {
  double c[2][3], e[2][3], origin[3], mean[3];
  double of_c[2][max_slave_nodes], of_e[2][max_slave_nodes], of_origin[max_slave_nodes];
};

/// Points of one simplex; those that are none have the rule 0, and the coordinates of another one.
template <int D>
struct PointBlock {
  static constexpr int R = D - 1;
  alignas(lane_alignment) double slave[R * LACON_LANES], master[R * LACON_LANES];  ///< reference coordinates
  alignas(lane_alignment) double rule[LACON_LANES];
  alignas(lane_alignment) double share[D * LACON_LANES];  ///< of the corners
  alignas(lane_alignment) double place[R * LACON_LANES];  ///< in a plane chart
};

template <int D, bool smooth, bool plane>
class PointKernel;

template <int D>
class PointSums {
 public:
  static constexpr int R = D - 1;

  /// @param sides derivatives of the reference coordinates by places in the chart  @param plane the chart is this one, instead
  void start(const ContactCellGeometry& cell, int n_corners, bool second, const std::array<double, R * R>& sides,
             const PlaneOfSlave* plane);
  /// Points of another simplex follow. @param corners of it, by number @param factor of second derivatives: the simplex's
  /// measure
  void start_simplex(const std::array<int, D>& corners, double factor);
  void add(const PointBlock<D>& block);
  void end_simplex();
  /// All points are there.
  void end();

  int columns() const { return columns_; }  ///< slave, master, nodal normals

  /// Of the simplex: sums of h, and derivatives without the chart's, by the variables of points and by its corners.
  struct Simplex {
    double value = 0;
    double gradient[3 * max_slave_nodes * D];
    double of_corner[D][R];
    // in a plane chart: by c, e, its origin and the mean normal
    double of_directions[2][3], of_sides[2][3], of_origin[3], of_mean[3];
    // factors in second derivatives: of corner times corner; in a plane chart of corner times dc . e, and times de
    double corner_pairs[D][D][R][R];
    double corner_by_c[D][2], corner_by_e[D][3];
  };
  const Simplex& simplex() const { return simplex_; }

  /// Factors in second derivatives of all points, by those.
  const double* by_nodes() const { return nodes_.data(); }              ///< (columns, columns)
  const double* by_corners() const { return of_corners_.sum(); }        ///< (corners, R, columns)
  const double* by_mean() const { return of_means_.sum(); }             ///< (3, columns): of the mean normal
  const double* by_directions() const { return of_offs_.sum(); }        ///< (3, 2, columns): of c
  double mean_by_node(int a, int d) const { return turned_[a][d]; }     ///< of dm . (v x dx_a)
  double direction_by_node(int i, int a) const { return held_[i][a]; }  ///< of dc_i . dx_a
  double second_of_mean(int d) const { return second_of_mean_[d]; }     ///< of d2m

 private:
  template <int, bool, bool>
  friend class PointKernel;  // point_kernel.cpp
  static constexpr int max_columns = 3 * max_slave_nodes * D;
  /// The sums of a simplex, or of a cell, still lane by lane.
  struct Sums {
    Lanes value, gradient[max_columns], of_corner[D][R], of_directions[2][3], of_sides[2][3], of_origin[3], of_mean[3];
    Lanes corner_pairs[D][D][R][R], corner_by_c[D][2], corner_by_e[D][3];
    Lanes turned[max_slave_nodes][3], held[2][max_slave_nodes], second_of_mean[3];  // of the cell
  };

  const ContactCellGeometry* cell_ = nullptr;
  const PlaneOfSlave* plane_ = nullptr;
  int slaves_ = 0, masters_ = 0, n_corners_ = 0, columns_ = 0;
  bool second_ = false;
  double factor_ = 0;
  std::array<double, R * R> sides_{};
  std::array<int, D> corners_{};
  alignas(lane_alignment) Sums sums_;
  Simplex simplex_;
  PointProducts of_skins_, of_slaves_, of_normals_, of_corners_, of_means_, of_offs_;
  std::vector<double> nodes_;
  double turned_[max_slave_nodes][3] = {}, held_[2][max_slave_nodes] = {}, second_of_mean_[3] = {};
};

}  // namespace lacon::variations
