#include "lacon/operators/meshing/quality.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "lacon/elements/lanes.hpp"
#include "lacon/elements/reference.hpp"
#include "lacon/structures/known_size.hpp"

namespace lacon {
namespace {

/// Below it, relative to the cell's greatest Jacobian, a corner counts as flat: round-off of differences of coordinates.
constexpr double flat_corner = 1e-10;

/// Of the first `dimension` rows and columns.
template <class Rows>
double determinant(const Rows& t, std::size_t dimension) {
  if (dimension == 1) return t[0][0];
  if (dimension == 2) return t[0][0] * t[1][1] - t[0][1] * t[1][0];
  return t[0][0] * (t[1][1] * t[2][2] - t[1][2] * t[2][1]) - t[0][1] * (t[1][0] * t[2][2] - t[1][2] * t[2][0]) +
         t[0][2] * (t[1][0] * t[2][1] - t[1][1] * t[2][0]);
}

std::array<double, 3> centre(const catalog::CellRow& row) {
  std::array<double, 3> xi{};
  const auto d = static_cast<std::size_t>(row.dimension);
  for (std::size_t v = 0; v < static_cast<std::size_t>(row.n_vertices); ++v)
    for (std::size_t k = 0; k < d; ++k) xi[k] += row.nodes[v * d + k] / row.n_vertices;
  return xi;
}

/// The gradients of a cell's shape functions at its centre, then at its nodes: (1 + n_nodes, n_nodes, dimension).
std::span<const double> gradients_of(CellType type) {
  static const auto tables = [] {
    std::vector<std::vector<double>> all;
    for (const catalog::CellRow& row : catalog::cells()) {
      const auto d = static_cast<std::size_t>(row.dimension), n = static_cast<std::size_t>(row.n_nodes);
      std::vector<double>& table = all.emplace_back((n + 1) * n * d);
      const std::array<double, 3> middle = centre(row);
      const double towards_centre = row.family == Family::PYRAM ? 0.1 : 0.0;
      for (std::size_t point = 0; d > 0 && point <= n; ++point) {
        std::array<double, 3> xi = middle;
        if (point > 0)
          for (std::size_t k = 0; k < d; ++k)
            xi[k] = (1 - towards_centre) * row.nodes[(point - 1) * d + k] + towards_centre * middle[k];
        shape_gradients(row.type, {xi.data(), d}, {table.data() + point * n * d, n * d});
      }
    }
    return all;
  }();
  return tables[static_cast<std::size_t>(type)];
}

constexpr std::size_t max_nodes = 27;

using Row = double __attribute__((vector_size(4 * sizeof(double))));  ///< three count

/// The determinant in d dimensions. @param place(a, x) sets x to the place of node a
template <std::size_t d, class Place>
[[gnu::always_inline]] inline double jacobian(std::size_t n_nodes, const double* gradients, const Place& place) {
  Row j[3] = {};
  for (std::size_t a = 0; a < n_nodes; ++a) {
    Row x;
    place(a, x);
    for (std::size_t i = 0; i < d; ++i) j[i] += gradients[d * a + i] * x;
  }
  return determinant(j, d);
}

/// The range of the determinants at the first `n_points` of gradients_of(), in d dimensions.
template <std::size_t d>
[[gnu::always_inline]] inline JacobianRange range_at(std::size_t n_points, std::span<const std::int32_t> nodes,
                                                     std::span<const double> coordinates, const double* gradients) {
  const auto read = [&](std::size_t a, Row& x) {
    const double* const of = coordinates.data() + 3 * std::ptrdiff_t{nodes[a]};
    x = Row{of[0], of[1], of[2], 0};
  };
  const double first = jacobian<d>(nodes.size(), gradients, read);
  JacobianRange range{first, first, first};
  if (n_points == 1) return range;
  Row places[max_nodes];
  for (std::size_t a = 0; a < nodes.size(); ++a) read(a, places[a]);
  for (std::size_t point = 1; point < n_points; ++point) {
    gradients += d * nodes.size();
    const double here = jacobian<d>(nodes.size(), gradients, [&](std::size_t a, Row& x) { x = places[a]; });
    range.least = std::min(range.least, here);
    range.greatest = std::max(range.greatest, here);
  }
  return range;
}

/// The same: a mesh has many cells, and this is asked of each.
LACON_KERNEL JacobianRange range_at(int dimension, std::size_t n_points, std::span<const std::int32_t> nodes,
                                    std::span<const double> coordinates, const double* gradients) {
  if (dimension == 3) return range_at<3>(n_points, nodes, coordinates, gradients);
  if (dimension == 2) return range_at<2>(n_points, nodes, coordinates, gradients);
  return range_at<1>(n_points, nodes, coordinates, gradients);
}

/// The cells of a run of one type whose determinant at the centre is negative. @param cells its `n_cells` rows of `n_nodes`
/// nodes
/// @param number of its first cell
LACON_KERNEL void find_inverted(int dimension, std::size_t n_nodes, std::size_t n_cells, const std::int32_t* cells,
                                std::int32_t number, std::span<const double> coordinates, const double* gradients,
                                std::vector<std::int32_t>& found) {
  with_known_size(
      n_nodes, [&](const auto n) __attribute__((always_inline)) {
        const auto inverted = [&](std::size_t c) __attribute__((always_inline)) {
          const std::span<const std::int32_t> nodes(cells + c * n, n);
          return (dimension == 3 ? range_at<3>(1, nodes, coordinates, gradients)
                                 : range_at<2>(1, nodes, coordinates, gradients))
                     .least < 0;
        };
        for (std::size_t c = 0; c < n_cells; ++c)
          if (inverted(c)) found.push_back(number + static_cast<std::int32_t>(c));
      });
}

JacobianRange range_at(CellType type, std::size_t n_points, std::span<const std::int32_t> nodes,
                       std::span<const double> coordinates) {
  return range_at(catalog::cell(type).dimension, n_points, nodes, coordinates, gradients_of(type).data());
}

}  // namespace

double central_jacobian(CellType type, std::span<const std::int32_t> nodes, std::span<const double> coordinates) {
  return range_at(type, 1, nodes, coordinates).least;
}

std::vector<std::int32_t> inverted_cells(const Mesh& mesh) {
  std::vector<std::int32_t> found;
  for_each_run(mesh, [&](const catalog::CellRow& row, std::size_t first, std::size_t n_cells) {
    if (row.dimension == mesh.dimension)
      find_inverted(row.dimension, static_cast<std::size_t>(row.n_nodes), n_cells, mesh.cells[first].data(),
                    static_cast<std::int32_t>(first), mesh.coordinates, gradients_of(row.type).data(), found);
  });
  return found;
}

JacobianRange jacobian_range(CellType type, std::span<const std::int32_t> nodes, std::span<const double> coordinates) {
  return range_at(type, 1 + nodes.size(), nodes, coordinates);
}

namespace {

/// A corner of a cell: its vertex and the edges that leave it, in the order in which their determinant is positive.
struct Corner {
  std::int8_t vertex;
  struct Leg {
    std::int8_t end, middle;  ///< middle: -1 in a linear cell
  };
  std::array<Leg, 3> legs;
};

/// The corners of a cell; at the apex of a pyramid, where one edge more meets than a cell has dimensions, one without each.
std::vector<Corner> corners_of(const catalog::CellRow& row) {
  std::vector<Corner> corners;
  const auto d = static_cast<std::size_t>(row.dimension);
  for (int v = 0; v < row.n_vertices && d > 1; ++v) {
    std::vector<Corner::Leg> legs;
    for (std::size_t e = 0; e < row.edges.size(); ++e)
      if (const auto [a, b] = row.edges[e]; a == v || b == v)
        legs.push_back({a == v ? b : a, static_cast<std::int8_t>(row.order == 2 ? row.n_vertices + static_cast<int>(e) : -1)});
    for (std::size_t first = 0; first < (legs.size() > d ? legs.size() : 1); ++first) {
      Corner corner{static_cast<std::int8_t>(v), {}};
      std::array<std::array<double, 3>, 3> tangents{};
      for (std::size_t i = 0; i < d; ++i) {
        corner.legs[i] = legs[(first + i) % legs.size()];
        for (std::size_t k = 0; k < d; ++k)
          tangents[i][k] =
              row.nodes[static_cast<std::size_t>(corner.legs[i].end) * d + k] - row.nodes[static_cast<std::size_t>(v) * d + k];
      }
      if (determinant(tangents, d) < 0) std::swap(corner.legs[0], corner.legs[1]);
      corners.push_back(corner);
    }
  }
  return corners;
}

/// The determinant of unit tangents at a corner of the cell of equal edges.
double ideal_corner(Family family) {
  switch (family) {
    case Family::TRIA:
    case Family::PENTA:
      return std::sqrt(3.0) / 2;
    case Family::TETRA:
    case Family::PYRAM:
      return std::sqrt(0.5);
    default:
      return 1;
  }
}

/// The least determinant of the unit tangents at some corners, in d dimensions.
template <std::size_t d>
double least_corner(std::span<const Corner> corners, std::span<const std::int32_t> nodes, const double* coordinates) {
  const auto at = [&](std::int8_t local) { return coordinates + 3 * std::ptrdiff_t{nodes[static_cast<std::size_t>(local)]}; };
  double least = INFINITY;
  for (const Corner& corner : corners) {
    const double* const vertex = at(corner.vertex);
    double tangents[d][d], squares = 1;  // of the lengths
    for (std::size_t i = 0; i < d; ++i) {
      const auto& [end, middle] = corner.legs[i];
      for (std::size_t k = 0; k < d; ++k) tangents[i][k] = at(end)[k] - vertex[k];
      if (middle >= 0)  // the tangent of the parabola through three nodes at its first
        for (std::size_t k = 0; k < d; ++k) tangents[i][k] = 4 * (at(middle)[k] - vertex[k]) - tangents[i][k];
      double square = 0;
      for (std::size_t k = 0; k < d; ++k) square += tangents[i][k] * tangents[i][k];
      squares *= square;
    }
    least = std::min(least, squares > 0 ? determinant(tangents, d) / std::sqrt(squares) : 0.0);
  }
  return least;
}

}  // namespace

double scaled_jacobian(CellType type, std::span<const std::int32_t> nodes, std::span<const double> coordinates) {
  static const auto corners = [] {
    std::vector<std::vector<Corner>> all;
    for (const catalog::CellRow& row : catalog::cells()) all.push_back(corners_of(row));
    return all;
  }();
  const catalog::CellRow& row = catalog::cell(type);
  const auto least = row.dimension == 3 ? least_corner<3> : least_corner<2>;
  return least(corners[static_cast<std::size_t>(type)], nodes, coordinates.data()) / ideal_corner(row.family);
}

Quality quality_of(std::vector<CellQuality> cells) {
  Quality quality{.n_cells = cells.size()};
  if (cells.empty()) return quality;
  for (const auto& [value, cell] : cells) quality.mean += value / static_cast<double>(cells.size());
  const auto worst = cells.begin() + static_cast<std::ptrdiff_t>(std::min(Quality::n_worst, cells.size()));
  std::partial_sort(cells.begin(), worst, cells.end());
  auto sorted = worst;  // what is behind is not less than what is before
  for (std::size_t q = 0; q < quality.quantiles.size(); ++q) {
    const auto last = static_cast<double>(cells.size() - 1);
    const auto at = cells.begin() + std::lround(Quality::fractions[q] * last);
    if (at >= sorted) {
      std::nth_element(sorted, at, cells.end());
      sorted = at;
    }
    quality.quantiles[q] = at->first;
  }
  cells.erase(worst, cells.end());
  quality.worst = std::move(cells);
  return quality;
}

bool is_sound(const JacobianRange& range) {
  return range.greatest > 0 && range.least >= -flat_corner * range.greatest && range.central > flat_corner * range.greatest;
}

}  // namespace lacon
