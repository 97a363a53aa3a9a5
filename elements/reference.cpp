#include "lacon/elements/reference.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>

#include "lacon/elements/lanes.hpp"

#pragma GCC diagnostic ignored "-Wpsabi"  // vectors are passed between inlined functions alone

namespace lacon {
namespace {

// ---------------------------------------------------------------------------------------------------- shape functions
//
// The shape functions of a cell are the basis, dual to its nodes, of a space of functions x^i y^j z^k / (1 - z)^l (l only in
// pyramids). The catalogue has the nodes; span_of() below has the spaces; everything else is algebra.

constexpr int max_nodes = 27, max_skin_nodes = 9;

struct Term {
  std::int8_t i, j, k, l;
};

/// The space of a cell's shape functions.
std::vector<Term> span_of(const catalog::CellRow& cell) {
  const int order = cell.order;
  const auto quadratic = [](int power) { return power >= 2 ? power : 0; };
  const auto contains = [&](int i, int j, int k) {
    switch (cell.family) {
      case Family::TRIA:
      case Family::TETRA:
      case Family::PYRAM:
        return i + j + k <= order;
      case Family::PENTA:
        return i + j + std::max(k, 1) <= order + 1;
      default:  // all products, or the serendipity space: at most one factor is quadratic
        return cell.n_nodes == std::pow(order + 1, cell.dimension) || quadratic(i) + quadratic(j) + quadratic(k) <= order;
    }
  };
  const auto top = [&](int axis) { return axis < cell.dimension ? order : 0; };
  std::vector<Term> terms;
  for (std::int8_t k = 0; k <= top(2); ++k)
    for (std::int8_t j = 0; j <= top(1); ++j)
      for (std::int8_t i = 0; i <= top(0); ++i)
        if (contains(i, j, k)) terms.push_back({i, j, k, 0});
  if (cell.family == Family::PYRAM)  // x y / (1 - z) times the polynomials of one degree less in x and y
    for (std::int8_t j = 0; j < order; ++j)
      for (std::int8_t i = 0; i + j < order; ++i)
        terms.push_back({static_cast<std::int8_t>(i + 1), static_cast<std::int8_t>(j + 1), 0, 1});
  return terms;
}

// What follows is compiled without fused multiplications (CMakeLists.txt): one point by itself (Real is double) and eight at a
// time (Points) get the same bits, whatever the processor.

/// One coordinate of eight points.
using Points = double __attribute__((vector_size(LACON_LANES * sizeof(double))));

/// Factors of the terms and their derivatives.
template <class Real>
struct Powers {
  Real value[3][3], slope[3][3];
  Real inverse;  ///< 1 / (1 - z); 0 at a pyramid's apex, where the limit of every x^a y^b / (1 - z), a + b > 1, is 0

  /// @param x (3), zero where the cell has no such coordinate
  [[gnu::always_inline]] explicit Powers(const Real (&x)[3]) {
    const Real zero{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Real powers[3] = {zero + 1.0, x[axis], x[axis] * x[axis]}, slopes[3] = {zero, zero + 1.0, 2 * x[axis]};
      std::copy_n(powers, 3, value[axis]);
      std::copy_n(slopes, 3, slope[axis]);
    }
    const Real below = 1 - x[2];
    inverse = below == 0.0 ? zero : 1 / below;
  }

  [[gnu::always_inline]] Real operator()(const Term& t) const { return value[0][t.i] * value[1][t.j] * height(t); }

  [[gnu::always_inline]] Real derivative(const Term& t, std::size_t axis) const {
    if (axis == 0) return slope[0][t.i] * value[1][t.j] * height(t);
    if (axis == 1) return value[0][t.i] * slope[1][t.j] * height(t);
    const Real plane = value[0][t.i] * value[1][t.j];
    return t.l ? plane * inverse * (slope[2][t.k] + value[2][t.k] * inverse) : plane * slope[2][t.k];
  }

 private:
  [[gnu::always_inline]] Real height(const Term& t) const { return t.l ? value[2][t.k] * inverse : value[2][t.k]; }
};

struct Space {
  std::vector<Term> terms;
  std::vector<double> coefficient;  ///< (terms, nodes): of each term in each shape function
};

Space make_space(const catalog::CellRow& cell) {
  Space space{span_of(cell), {}};
  const int n = cell.n_nodes;
  if (static_cast<int>(space.terms.size()) != n || n > max_nodes)
    throw std::logic_error("no space of shape functions for the cell " + std::string(cell.name));
  Eigen::MatrixXd at_nodes(n, n);
  for (int a = 0; a < n; ++a) {
    double x[3] = {};
    std::copy_n(cell.nodes.begin() + a * cell.dimension, cell.dimension, x);
    const Powers<double> powers(x);
    for (int t = 0; t < n; ++t) at_nodes(a, t) = powers(space.terms[static_cast<std::size_t>(t)]);
  }
  const Eigen::MatrixXd inverse = at_nodes.fullPivLu().inverse();
  space.coefficient.resize(static_cast<std::size_t>(n * n));
  for (int t = 0; t < n; ++t)
    for (int a = 0; a < n; ++a) {
      // nodes at 0, 1/2 and 1 give multiples of 1/8: rounding makes the coefficients exact
      const double exact = std::round(8 * inverse(t, a)) / 8;
      if (!(std::abs(exact - inverse(t, a)) < 1e-10))
        throw std::logic_error("the nodes of the cell " + std::string(cell.name) + " do not fit its shape functions");
      space.coefficient[static_cast<std::size_t>(t * n + a)] = exact;
    }
  return space;
}

const Space& space_of(CellType type) {
  static const std::vector<Space> spaces = [] {
    std::vector<Space> all;
    for (const catalog::CellRow& row : catalog::cells()) all.push_back(make_space(row));
    return all;
  }();
  return spaces[static_cast<std::size_t>(type)];
}

/// What is computed of the terms: their values, or their derivatives along each axis.
enum class Quantity { value, derivative };

template <Quantity Q, class Real>
[[gnu::always_inline]] inline Real of_term(const Powers<Real>& powers, const Term& term, std::size_t axis) {
  if constexpr (Q == Quantity::value) return powers(term);
  return powers.derivative(term, axis);
}

/// At one point. @param n_axes dimension for derivatives, otherwise 1 @param[out] out (nodes, n_axes)
template <Quantity Q>
void at_point(const Space& space, std::size_t dimension, std::size_t n_axes, const double* xi, double* out) {
  const std::size_t n = space.terms.size();
  double x[3] = {};
  std::copy_n(xi, dimension, x);
  const Powers<double> powers(x);
  std::fill_n(out, n * n_axes, 0.0);
  for (std::size_t t = 0; t < n; ++t)
    for (std::size_t axis = 0; axis < n_axes; ++axis) {
      const double factor = of_term<Q>(powers, space.terms[t], axis);
      if (factor == 0.0) continue;
      for (std::size_t a = 0; a < n; ++a) out[a * n_axes + axis] += space.coefficient[t * n + a] * factor;
    }
}

/// At many points. @param xi (n_points, dimension) @param[out] out (n_points, nodes, n_axes)
template <Quantity Q>
[[gnu::always_inline]] inline void at_points(const Space& space, std::size_t dimension, std::size_t n_axes,
                                             std::size_t n_points, const double* xi, double* out) {
  const std::size_t n = space.terms.size();
  Points factor[max_nodes];
  double column[3 * LACON_LANES] = {}, row[LACON_LANES];
  for (std::size_t first = 0; first < n_points; first += LACON_LANES) {
    const std::size_t count = std::min<std::size_t>(LACON_LANES, n_points - first);
    for (std::size_t axis = 0; axis < dimension; ++axis)
      for (std::size_t lane = 0; lane < count; ++lane)
        column[axis * LACON_LANES + lane] = xi[(first + lane) * dimension + axis];
    const Points x[3] = {lanes(column, 0), lanes(column, 1), lanes(column, 2)};
    const Powers<Points> powers(x);
    for (std::size_t axis = 0; axis < n_axes; ++axis) {
      for (std::size_t t = 0; t < n; ++t) factor[t] = of_term<Q>(powers, space.terms[t], axis);
      for (std::size_t a = 0; a < n; ++a) {
        Points sum = space.coefficient[a] * factor[0];
        for (std::size_t t = 1; t < n; ++t) sum += space.coefficient[t * n + a] * factor[t];
        lanes(row, 0) = sum;
        double* const to = out + (first * n + a) * n_axes + axis;
        if (count == LACON_LANES)
          for (std::size_t lane = 0; lane < LACON_LANES; ++lane) to[lane * n * n_axes] = row[lane];
        else
          for (std::size_t lane = 0; lane < count; ++lane) to[lane * n * n_axes] = row[lane];
      }
    }
  }
}

/// Powers of a coordinate, derived.
struct DerivedPowers {
  Points of[3][4];  ///< power, times derived

  [[gnu::always_inline]] explicit DerivedPowers(const Points& x) {
    const Points zero{}, one = zero + 1.0;
    const Points all[3][4] = {{one, zero, zero, zero}, {x, one, zero, zero}, {x * x, 2 * x, one + one, zero}};
    std::memcpy(of, all, sizeof of);
  }
};

/// All derivatives up to an order on a skin. @param[out] out (derivatives, nodes, LACON_LANES)
LACON_KERNEL void derivatives_at(const Space& space, bool surface, const double* xi, int order, double* out) {
  const std::size_t n = space.terms.size();
  const DerivedPowers x(lanes(xi, 0)), y(surface ? Points(lanes(xi, 1)) : Points{});
  for (int times = 0; times <= order; ++times)
    for (int by_y = 0; by_y <= (surface ? times : 0); ++by_y, out += n * LACON_LANES) {
      Points sum[max_skin_nodes] = {};
      for (std::size_t t = 0; t < n; ++t) {
        const Term& term = space.terms[t];
        if (term.i < times - by_y || term.j < by_y) continue;
        const Points factor = x.of[term.i][times - by_y] * y.of[term.j][by_y];
        for (std::size_t a = 0; a < n; ++a) sum[a] += space.coefficient[t * n + a] * factor;
      }
      for (std::size_t a = 0; a < n; ++a) lanes(out, static_cast<std::int64_t>(a)) = sum[a];
    }
}

LACON_KERNEL void functions_at(const Space& space, std::size_t dimension, std::size_t n_points, const double* xi, double* out) {
  at_points<Quantity::value>(space, dimension, 1, n_points, xi, out);
}
LACON_KERNEL void gradients_at(const Space& space, std::size_t dimension, std::size_t n_points, const double* xi, double* out) {
  at_points<Quantity::derivative>(space, dimension, dimension, n_points, xi, out);
}

}  // namespace

void shape_functions(CellType type, std::span<const double> xi, std::span<double> values) {
  const auto dimension = static_cast<std::size_t>(catalog::cell(type).dimension);
  const Space& space = space_of(type);
  assert(xi.size() % std::max<std::size_t>(dimension, 1) == 0);
  if (xi.size() == dimension) return at_point<Quantity::value>(space, dimension, 1, xi.data(), values.data());
  assert(values.size() * dimension >= xi.size() * space.terms.size());
  functions_at(space, dimension, xi.size() / dimension, xi.data(), values.data());
}

void shape_gradients(CellType type, std::span<const double> xi, std::span<double> gradients) {
  const auto dimension = static_cast<std::size_t>(catalog::cell(type).dimension);
  const Space& space = space_of(type);
  assert(xi.size() % std::max<std::size_t>(dimension, 1) == 0);
  assert(gradients.size() >= xi.size() * space.terms.size());
  if (xi.size() == dimension) return at_point<Quantity::derivative>(space, dimension, dimension, xi.data(), gradients.data());
  gradients_at(space, dimension, xi.size() / dimension, xi.data(), gradients.data());
}

void shape_derivatives(CellType type, std::span<const double> xi, int order, std::span<double> derivatives) {
  const auto dimension = static_cast<std::size_t>(catalog::cell(type).dimension);
  const Space& space = space_of(type);
  const std::size_t n = space.terms.size(), columns = dimension == 2 ? static_cast<std::size_t>(order) + 1 : 1;
  assert(dimension <= 2 && xi.size() == dimension && derivatives.size() >= n * columns);
  const auto of_power = [](int power, int times, double x) {  // of x^power
    double value = 1;
    for (int k = 0; k < times; ++k) value *= power - k;
    for (int k = times; k < power; ++k) value *= x;
    return value;
  };
  std::fill_n(derivatives.begin(), n * columns, 0.0);
  for (std::size_t t = 0; t < n; ++t)
    for (std::size_t k = 0; k < columns; ++k) {
      const Term& term = space.terms[t];
      const int by_eta = static_cast<int>(k);
      const double factor = of_power(term.i, order - by_eta, xi[0]) * (dimension == 2 ? of_power(term.j, by_eta, xi[1]) : 1.0);
      if (factor == 0) continue;
      for (std::size_t a = 0; a < n; ++a) derivatives[a * columns + k] += space.coefficient[t * n + a] * factor;
    }
}

void shape_lanes(CellType type, const double* xi, int order, double* derivatives) {
  const int dimension = catalog::cell(type).dimension;
  assert(dimension <= 2 && order <= 3);
  derivatives_at(space_of(type), dimension == 2, xi, order, derivatives);
}

Tabulation tabulate(CellType type, const Rule& rule) {
  const catalog::CellRow& cell = catalog::cell(type);
  if (rule.dimension != cell.dimension)
    throw std::logic_error("an integration rule of dimension " + std::to_string(rule.dimension) + " on the cell " +
                           std::string(cell.name));
  const std::size_t points = rule.weights.size(), nodes = static_cast<std::size_t>(cell.n_nodes);
  const std::size_t dimension = static_cast<std::size_t>(cell.dimension);
  Tabulation table{rule.size(),
                   cell.n_nodes,
                   cell.dimension,
                   std::vector<double>(points * nodes),
                   std::vector<double>(points * nodes * dimension),
                   rule.weights};
  shape_functions(type, rule.points, table.shape);
  shape_gradients(type, rule.points, table.gradient);
  return table;
}

}  // namespace lacon
