// Derivatives of integrated gaps against differences of what pairing and integration give.
#include "lacon/operators/contact/gap_variation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "lacon/operators/contact/normal_variation.hpp"
#include "lacon/pairing/normals.hpp"
#include "lacon/pairing/pairing.hpp"

namespace lacon {
namespace {

/// The largest difference of a matrix from its transpose.
double asymmetry(const std::vector<double>& matrix, std::size_t n) {
  double largest = 0;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < i; ++j) largest = std::max(largest, std::abs(matrix[i * n + j] - matrix[j * n + i]));
  return largest;
}

/// A slave cell over a chain of masters, in the plane: a part of a large arc over a wavy line, any nodes moved at random.
struct InPlane {
  CellType slave_type, master_type;
  bool axis, current, smooth;
  std::vector<double> coordinates, initial;
  std::vector<std::vector<std::int32_t>> slaves, masters;

  InPlane(CellType slave, CellType master, bool on_axis, bool actual, bool smoothing, unsigned seed)
      : slave_type(slave), master_type(master), axis(on_axis), current(actual), smooth(smoothing) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-0.04, 0.04);
    const auto chain = [&](CellType type, int n, double from, double to, double height, auto& cells) {
      const int order = catalog::cell(type).order;
      const auto first = static_cast<std::int32_t>(coordinates.size() / 3);
      for (int i = 0; i <= n * order; ++i) {
        const double x = from + (to - from) * i / (n * order);
        coordinates.insert(coordinates.end(), {x + uniform(random), height + 0.2 * std::sin(2 * x) + uniform(random), 0});
      }
      for (int c = 0; c < n; ++c) {
        const std::int32_t a = first + c * order;
        cells.push_back({a, a + order});
        if (order == 2) cells.back().push_back(a + 1);
      }
    };
    chain(slave, 2, 1.0, 2.0, 0.3, slaves);
    // outward is to the right of a chain: the master below is followed backward, and ends over the second slave cell
    chain(master, 5, 1.87, 0.6, 0.15, masters);
    initial = coordinates;
    for (double& x : initial) x += uniform(random);
    for (std::size_t i = 2; i < coordinates.size(); i += 3) coordinates[i] = initial[i] = 0;
  }

  struct Sum {
    double gap = 0;
    std::vector<double> gradient, hessian;
  };

  Sum evaluate(bool second) const {
    Surface slave{.dimension = 2, .types = {}, .nodes = {}, .coordinates = coordinates, .normals = {}}, master = slave;
    for (const auto& cell : slaves) slave.add_cell(slave_type, cell);
    for (const auto& cell : masters) master.add_cell(master_type, cell);
    std::vector<double> normals;
    if (smooth) normals = nodal_normals(slave);
    slave.normals = normals;
    const NormalVariation of_normals(slave);
    const ContactCells cells = pair(slave, master).cells;
    const std::size_t n = coordinates.size() / 3;
    Sum sum{0, std::vector<double>(2 * n), std::vector<double>(4 * n * n)};
    GapVariation variation;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      std::vector<std::int32_t> nodes = slaves[static_cast<std::size_t>(cells.slave[c])];
      const auto& others = masters[static_cast<std::size_t>(cells.master[c])];
      const std::size_t ns = nodes.size();
      nodes.insert(nodes.end(), others.begin(), others.end());
      const std::size_t known = nodes.size();
      ContactCellGeometry cell{.slave = slave_type, .master = master_type, .axis = axis, .current_jacobian = current};
      for (std::size_t k = 0; k < 2; ++k) {
        const std::int32_t node = cells.vertex_node[2 * c + k];
        cell.ends[k] = {cells.vertex[2 * c + k], -1};
        if (node < 0) continue;
        auto at = std::find(nodes.begin() + static_cast<long>(ns), nodes.end(), node);
        if (at == nodes.end()) at = nodes.insert(nodes.end(), node);
        cell.ends[k].node = static_cast<int>(at - nodes.begin());
      }
      std::vector<double> now, before, at_nodes;
      for (const std::int32_t node : nodes)
        for (int d = 0; d < 2; ++d) {
          now.push_back(coordinates[static_cast<std::size_t>(3 * node + d)]);
          before.push_back(initial[static_cast<std::size_t>(3 * node + d)]);
        }
      const std::span<const double> all(now);
      cell.slave_initial = std::span(before).first(2 * ns);
      cell.slave_nodes = all.first(2 * ns);
      cell.master_nodes = all.subspan(2 * ns, 2 * (known - ns));
      cell.other_nodes = all.subspan(2 * known);
      const auto first = static_cast<std::size_t>(cells.offset[c]),
                 count = static_cast<std::size_t>(cells.offset[c + 1]) - first;
      cell.slave_point = std::span(cells.slave_point).subspan(first, count);
      cell.master_point = std::span(cells.master_point).subspan(first, count);
      cell.weight = std::span(cells.weight).subspan(first, count);
      for (std::size_t i = 0; smooth && i < ns; ++i)
        at_nodes.insert(at_nodes.end(),
                        {normals[static_cast<std::size_t>(3 * nodes[i])], normals[static_cast<std::size_t>(3 * nodes[i] + 1)]});
      cell.slave_normals = at_nodes;
      vary_gap(cell, second, variation);
      if (smooth) {
        std::vector<std::int32_t> around = nodes;
        of_normals.append_nodes_around(slave, std::span(nodes).first(ns), around);
        of_normals.apply(slave, nodes, static_cast<int>(ns), around, variation);
        nodes = around;
      }
      sum.gap += variation.gap;
      const auto global = [&](std::size_t i) { return static_cast<std::size_t>(2 * nodes[i / 2]) + i % 2; };
      const std::size_t m = variation.gradient.size();
      for (std::size_t i = 0; i < m; ++i) {
        sum.gradient[global(i)] += variation.gradient[i];
        for (std::size_t j = 0; second && j < m; ++j)
          sum.hessian[global(i) * 2 * n + global(j)] += variation.hessian[i * m + j];
      }
    }
    return sum;
  }
};

TEST(GapVariation, DerivativesInThePlaneAreThoseOfDifferences) {
  constexpr double step = 2e-6;
  unsigned seed = 1;
  for (const CellType slave : {CellType::SEG2, CellType::SEG3})
    for (const CellType master : {CellType::SEG2, CellType::SEG3})
      for (const bool axis : {false, true})
        for (const bool current : {false, true})
          for (const bool smooth : {false, true}) {
            InPlane skins(slave, master, axis, current, smooth, ++seed);
            const InPlane::Sum at = skins.evaluate(true);
            const std::size_t n = at.gradient.size();
            double largest = 0, largest_second = 0;
            for (const double g : at.gradient) largest = std::max(largest, std::abs(g));
            for (const double h : at.hessian) largest_second = std::max(largest_second, std::abs(h));
            EXPECT_GT(largest, 0.1);
            EXPECT_GT(largest_second, 0.1);
            for (std::size_t i = 0; i < n; ++i) {
              double& x = skins.coordinates[3 * (i / 2) + i % 2];
              const double middle = x;
              x = middle + step;
              const InPlane::Sum ahead = skins.evaluate(false);
              x = middle - step;
              const InPlane::Sum behind = skins.evaluate(false);
              x = middle;
              EXPECT_NEAR(at.gradient[i], (ahead.gap - behind.gap) / (2 * step), 1e-7 * largest) << i << " of seed " << seed;
              for (std::size_t j = 0; j < n; ++j)
                EXPECT_NEAR(at.hessian[i * n + j], (ahead.gradient[j] - behind.gradient[j]) / (2 * step), 1e-7 * largest_second)
                    << i << ' ' << j << " of seed " << seed;
            }
          }
}

/// A slave cell, with its neighbour, over masters that reach beyond it on some sides only; in space.
struct InSpace {
  CellType slave_type, master_type;
  bool current, smooth;
  std::vector<double> coordinates, initial;
  std::vector<std::vector<std::int32_t>> slaves, masters;

  /// @param bend how far nodes are moved at random, and how much the surfaces are curved
  InSpace(CellType slave, CellType master, bool actual, bool smoothing, double bend, unsigned seed)
      : slave_type(slave), master_type(master), current(actual), smooth(smoothing) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto skin = [&](CellType type, double x0, double y0, double dx, double dy, int nx, bool up, double z, auto& cells) {
      const catalog::CellRow& row = catalog::cell(type);
      std::map<std::pair<int, int>, std::int32_t> nodes;
      const auto node = [&](int i, int j) {  // on a grid of half steps
        const auto [place, added] = nodes.try_emplace({i, j}, static_cast<std::int32_t>(coordinates.size() / 3));
        if (added) {
          const double x = x0 + 0.5 * dx * i, y = y0 + 0.5 * dy * j;
          coordinates.insert(coordinates.end(), {x + bend * uniform(random), y + bend * uniform(random),
                                                 z + bend * (uniform(random) + 2 * std::sin(x + 2 * y))});
        }
        return place->second;
      };
      for (int c = 0; c < nx; ++c) {
        const int i = 2 * c;
        std::vector<std::vector<std::pair<int, int>>> corners = {{{i, 0}, {i + 2, 0}, {i + 2, 2}, {i, 2}}};
        if (row.family == Family::TRIA) corners = {{{i, 0}, {i + 2, 0}, {i + 2, 2}}, {{i, 0}, {i + 2, 2}, {i, 2}}};
        for (auto& polygon : corners) {
          if (!up) std::reverse(polygon.begin(), polygon.end());
          auto& cell = cells.emplace_back();
          for (const auto& [a, b] : polygon) cell.push_back(node(a, b));
          for (std::size_t k = 0; row.order == 2 && k < polygon.size(); ++k) {
            const auto& [a, b] = polygon[k];
            const auto& [c2, d] = polygon[(k + 1) % polygon.size()];
            cell.push_back(node((a + c2) / 2, (b + d) / 2));
          }
          if (type == CellType::QUAD9) cell.push_back(node(i + 1, 1));
        }
      }
    };
    skin(slave, 0, 0, 1, 1, 2, false, 0.25, slaves);
    skin(master, 0.12, -0.2, 0.61, 0.93, 3, true, 0, masters);
    initial = coordinates;
    for (double& x : initial) x += 0.05 * uniform(random);
  }

  struct Sum {
    double gap = 0;
    std::vector<double> gradient, hessian;
  };

  Sum evaluate(bool second) const {
    Surface slave{.dimension = 3, .types = {}, .nodes = {}, .coordinates = coordinates, .normals = {}}, master = slave;
    for (const auto& cell : slaves) slave.add_cell(slave_type, cell);
    for (const auto& cell : masters) master.add_cell(master_type, cell);
    std::vector<double> normals;
    if (smooth) normals = nodal_normals(slave);
    slave.normals = normals;
    const NormalVariation of_normals(slave);
    const Pairing found = pair(slave, master, {.tolerances = {.ray = 1e-14}, .traced = true});
    const ContactCells& cells = found.cells;
    const std::size_t n = coordinates.size();
    Sum sum{0, std::vector<double>(n), std::vector<double>(second ? n * n : 0)};
    GapVariation variation;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      std::vector<std::int32_t> nodes = slaves[static_cast<std::size_t>(cells.slave[c])];
      const auto& others = masters[static_cast<std::size_t>(cells.master[c])];
      const std::size_t ns = nodes.size();
      nodes.insert(nodes.end(), others.begin(), others.end());
      const std::size_t known = nodes.size();
      ContactCellGeometry cell{.slave = slave_type, .master = master_type, .dimension = 3, .current_jacobian = current};
      cell.trace = &found.traces[c];
      for (const PolygonTrace::Line& line : cell.trace->line) {
        auto& own = cell.lines.emplace_back();
        if (line.master < 0) continue;
        own.type = master_type;
        const auto& drawn_on = masters[static_cast<std::size_t>(line.master)];
        for (std::size_t a = 0; a < drawn_on.size(); ++a) {
          auto at = std::find(nodes.begin() + static_cast<long>(ns), nodes.end(), drawn_on[a]);
          if (at == nodes.end()) at = nodes.insert(at, drawn_on[a]);
          own.node[a] = static_cast<int>(at - nodes.begin());
        }
      }
      std::vector<double> now, before, at_nodes;
      for (const std::int32_t node : nodes)
        for (int d = 0; d < 3; ++d) {
          now.push_back(coordinates[static_cast<std::size_t>(3 * node + d)]);
          before.push_back(initial[static_cast<std::size_t>(3 * node + d)]);
        }
      for (std::size_t i = 0; smooth && i < ns; ++i)
        for (int d = 0; d < 3; ++d) at_nodes.push_back(normals[static_cast<std::size_t>(3 * nodes[i] + d)]);
      const std::span<const double> all(now);
      cell.slave_initial = std::span(before).first(3 * ns);
      cell.slave_nodes = all.first(3 * ns);
      cell.master_nodes = all.subspan(3 * ns, 3 * (known - ns));
      cell.other_nodes = all.subspan(3 * known);
      cell.slave_normals = at_nodes;
      const auto first = static_cast<std::size_t>(cells.offset[c]),
                 count = static_cast<std::size_t>(cells.offset[c + 1]) - first;
      cell.slave_point = std::span(cells.slave_point).subspan(2 * first, 2 * count);
      cell.master_point = std::span(cells.master_point).subspan(2 * first, 2 * count);
      cell.weight = std::span(cells.weight).subspan(first, count);
      vary_gap(cell, second, variation);
      if (smooth) {
        std::vector<std::int32_t> around = nodes;
        of_normals.append_nodes_around(slave, std::span(nodes).first(ns), around);
        of_normals.apply(slave, nodes, static_cast<int>(ns), around, variation);
        nodes = around;
      }
      sum.gap += variation.gap;
      const auto global = [&](std::size_t i) { return static_cast<std::size_t>(3 * nodes[i / 3]) + i % 3; };
      const std::size_t m = variation.gradient.size();
      for (std::size_t i = 0; i < m; ++i) {
        sum.gradient[global(i)] += variation.gradient[i];
        for (std::size_t j = 0; second && j < m; ++j) sum.hessian[global(i) * n + global(j)] += variation.hessian[i * m + j];
      }
    }
    return sum;
  }
};

TEST(GapVariation, DerivativesInSpaceAreThoseOfDifferences) {
  constexpr double step = 1e-6;
  int compared = 0, rough = 0;
  unsigned seed = 400;
  const CellType kinds[] = {CellType::TRIA3, CellType::QUAD4, CellType::TRIA6, CellType::QUAD8, CellType::QUAD9};
  for (const CellType slave : kinds)
    for (const CellType master : kinds) {
      const bool smooth = ++seed % 3 == 0;
      InSpace skins(slave, master, seed % 4 < 2, smooth, 0.03, seed);
      const InSpace::Sum at = skins.evaluate(true);
      const std::size_t n = at.gradient.size();
      double largest = 0, largest_second = 0;
      for (const double g : at.gradient) largest = std::max(largest, std::abs(g));
      for (const double h : at.hessian) largest_second = std::max(largest_second, std::abs(h));
      EXPECT_GT(largest, 0.02);
      EXPECT_GT(largest_second, 0.02);
      EXPECT_LT(asymmetry(at.hessian, n), 1e-12 * largest_second);
      std::mt19937 random(seed);
      std::uniform_real_distribution<double> uniform(-1, 1);
      for (int direction = 0; direction < 1; ++direction) {
        std::vector<double> along(n);
        for (double& d : along) d = uniform(random);
        const std::vector<double> middle = skins.coordinates;
        const auto moved = [&](double by) {
          for (std::size_t i = 0; i < n; ++i) skins.coordinates[i] = middle[i] + by * along[i];
          const InSpace::Sum sum = skins.evaluate(false);
          skins.coordinates = middle;
          return sum;
        };
        const InSpace::Sum ahead = moved(step), behind = moved(-step), far_ahead = moved(4 * step),
                           far_behind = moved(-4 * step);
        const std::string what = std::string(catalog::cell(slave).name) + " over " + std::string(catalog::cell(master).name) +
                                 (smooth ? ", smooth, " : ", ") + std::to_string(seed);
        // where a corner passes an edge on the way, or two lines are nearly one, differences say nothing: they are not the
        // same for two steps
        const auto compare = [&](double derivative, double difference, double far, double scale) {
          ++compared;
          if (std::abs(difference - far) > 1e-7 * scale)
            ++rough;
          else
            EXPECT_LE(std::min(std::abs(derivative - difference), std::abs(derivative - far)), 1e-7 * scale) << what;
        };
        double slope = 0;
        for (std::size_t i = 0; i < n; ++i) slope += at.gradient[i] * along[i];
        compare(slope, (ahead.gap - behind.gap) / (2 * step), (far_ahead.gap - far_behind.gap) / (8 * step), largest);
        for (std::size_t j = 0; j < n; ++j) {
          double turn = 0;
          for (std::size_t i = 0; i < n; ++i) turn += at.hessian[j * n + i] * along[i];
          compare(turn, (ahead.gradient[j] - behind.gradient[j]) / (2 * step),
                  (far_ahead.gradient[j] - far_behind.gradient[j]) / (8 * step), largest_second);
        }
      }
    }
  EXPECT_GT(compared, 1000);
  EXPECT_LT(rough, compared / 10);
}

}  // namespace
}  // namespace lacon
