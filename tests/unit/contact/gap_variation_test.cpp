// Derivatives of integrated gaps against differences of what pairing and integration give.
#include "lacon/operators/contact/variation/gap_variation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "lacon/operators/contact/variation/normal_variation.hpp"
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

/// A slave skin over a master skin, all cells of a skin of one kind, and what vary_gap() says of it.
struct VariedSkins {
  int dimension;
  CellType slave_type, master_type;
  bool axis, current, smooth;
  std::vector<double> coordinates, initial;  ///< (n_nodes, 3)
  std::vector<std::vector<std::int32_t>> slaves, masters;
  std::vector<double> offset = {};          ///< (n_nodes), by which the skins stand out of their cells; or empty
  double fading = 0;                        ///< PairingOptions::fading
  double steep_angle = 85;                  ///< PairingOptions::steep_angle
  std::vector<std::uint8_t> mirrored = {};  ///< Surface::mirrored of the masters
  int degree = 0;                           ///< PairingOptions::degree

  /// The sum over all contact cells.
  struct Sum {
    double gap = 0;
    std::vector<double> gradient, hessian;  ///< by (n_nodes, 3)
    std::size_t in_one = 0, traced = 0;     ///< contact cells in space
  };

  std::size_t size() const { return coordinates.size(); }

  Sum evaluate(bool second) const {
    Surface slave{.dimension = dimension, .types = {}, .nodes = {}, .coordinates = coordinates, .normals = {}}, master = slave;
    for (const auto& cell : slaves) slave.add_cell(slave_type, cell);
    for (const auto& cell : masters) master.add_cell(master_type, cell);
    master.mirrored = mirrored;
    std::vector<double> normals;
    if (smooth) normals = nodal_normals(slave);
    slave.normals = normals;
    const NormalVariation of_normals(slave);
    // images to round-off: differences divide their error by the step
    const PairingOptions options{
        .tolerances = {.ray = 1e-14}, .steep_angle = steep_angle, .degree = degree, .fading = fading, .traced = dimension == 3};
    Pairing found;
    PairingInParts(slave, master, options).pair(0, slave.size(), found, second ? 2 : 1);
    Sum sum{0, std::vector<double>(size()), std::vector<double>(second ? size() * size() : 0)};
    for (std::size_t c = 0; c < found.cells.size(); ++c) add(found, c, normals, slave, of_normals, second, sum);
    for (const PolygonTrace& trace : found.traces) ++(trace.vertex.empty() ? sum.in_one : sum.traced);
    return sum;
  }

 private:
  void add(const Pairing& found, std::size_t c, const std::vector<double>& normals, const Surface& slave,
           const NormalVariation& of_normals, bool second, Sum& sum) const {
    const ContactCells& cells = found.cells;
    const auto d = static_cast<std::size_t>(dimension), reference = d - 1;
    std::vector<std::int32_t> nodes = slaves[static_cast<std::size_t>(cells.slave[c])];
    const auto& others = masters[static_cast<std::size_t>(cells.master[c])];
    const std::size_t ns = nodes.size();
    nodes.insert(nodes.end(), others.begin(), others.end());
    const std::size_t known = nodes.size();
    ContactCellGeometry cell{.slave = slave_type,
                             .master = master_type,
                             .dimension = dimension,
                             .axis = axis,
                             .current_jacobian = current,
                             .steep = steep_cosine({.steep_angle = steep_angle})};
    const auto local = [&](std::int32_t node) {
      auto at = std::find(nodes.begin() + static_cast<long>(ns), nodes.end(), node);
      if (at == nodes.end()) at = nodes.insert(at, node);
      return static_cast<int>(at - nodes.begin());
    };
    if (dimension == 2) {
      for (std::size_t k = 0; k < 2; ++k) {
        const std::int32_t node = cells.vertex_node[2 * c + k];
        cell.ends[k] = {cells.vertex[2 * c + k], node < 0 ? -1 : local(node), cells.vertex_crossing[2 * c + k]};
      }
      cell.fading = fading;
    } else {
      cell.trace = &found.traces[c];
      for (const PolygonTrace::Line& line : cell.trace->line) {
        auto& own = cell.lines.emplace_back();
        if (line.master < 0) continue;
        own.type = master_type;
        std::size_t a = 0;
        for (const std::int32_t node : masters[static_cast<std::size_t>(line.master)]) own.node[a++] = local(node);
      }
    }
    const auto values = [&](const std::vector<double>& of, std::size_t count) {
      std::vector<double> taken;
      for (std::size_t i = 0; i < count; ++i)
        for (std::size_t k = 0; k < d; ++k) taken.push_back(of[3 * static_cast<std::size_t>(nodes[i]) + k]);
      return taken;
    };
    const std::vector<double> now = values(coordinates, nodes.size()), before = values(initial, ns),
                              at_nodes = smooth ? values(normals, ns) : std::vector<double>();
    cell.slave_initial = before;
    cell.slave_nodes = std::span(now).first(d * ns);
    cell.master_nodes = std::span(now).subspan(d * ns, d * (known - ns));
    cell.other_nodes = std::span(now).subspan(d * known);
    cell.slave_normals = at_nodes;
    std::vector<double> offset_at_nodes;
    for (std::size_t a = 0; a < ns && !offset.empty(); ++a)
      offset_at_nodes.push_back(offset[static_cast<std::size_t>(nodes[a])]);
    cell.slave_offset = offset_at_nodes;
    const auto first = static_cast<std::size_t>(cells.offset[c]), count = static_cast<std::size_t>(cells.offset[c + 1]) - first;
    cell.slave_point = std::span(cells.slave_point).subspan(reference * first, reference * count);
    cell.master_point = std::span(cells.master_point).subspan(reference * first, reference * count);
    cell.weight = std::span(cells.weight).subspan(first, count);
    GapVariation variation;
    vary_gap(cell, second, variation);
    if (smooth) {
      std::vector<std::int32_t> around = nodes;
      of_normals.append_nodes_around(slave, std::span(nodes).first(ns), around);
      of_normals.apply(slave, nodes, static_cast<int>(ns), around, variation);
      nodes = around;
    }
    sum.gap += variation.gap;
    const auto global = [&](std::size_t i) { return 3 * static_cast<std::size_t>(nodes[i / d]) + i % d; };
    const std::size_t m = variation.gradient.size();
    for (std::size_t i = 0; i < m; ++i) {
      sum.gradient[global(i)] += variation.gradient[i];
      for (std::size_t j = 0; second && j < m; ++j) sum.hessian[global(i) * size() + global(j)] += variation.hessian[i * m + j];
    }
  }
};

double largest_of(const std::vector<double>& values) {
  double largest = 0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

/// Where both bodies move together G is what it was: forces and moments balance, and a rotation W x turns the forces, H W x = W
/// dG.
void expect_rigid_motions_change_nothing(const VariedSkins& skins, const VariedSkins::Sum& at, const std::string& what) {
  const std::size_t n = skins.size();
  const double largest = largest_of(at.gradient), largest_second = largest_of(at.hessian);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t p = (k + 1) % 3, q = (k + 2) % 3;
    double force = 0, moment = 0;
    for (std::size_t i = 0; i < n; i += 3) {
      force += at.gradient[i + k];
      moment += skins.coordinates[i + p] * at.gradient[i + q] - skins.coordinates[i + q] * at.gradient[i + p];
    }
    EXPECT_NEAR(force, 0, 1e-12 * largest) << what;
    if (skins.dimension == 2 && k < 2) continue;  // out of the plane
    EXPECT_NEAR(moment, 0, 1e-12 * largest) << what;
    for (std::size_t j = 0; j < n; ++j) {
      double turned = 0;
      for (std::size_t i = 0; i < n; i += 3)
        turned += at.hessian[j * n + i + q] * skins.coordinates[i + p] - at.hessian[j * n + i + p] * skins.coordinates[i + q];
      const double expected = j % 3 == q ? at.gradient[j - q + p] : j % 3 == p ? -at.gradient[j - p + q] : 0;
      EXPECT_NEAR(turned, expected, 1e-11 * largest_second) << what;
    }
  }
}

/// A slave cell over a chain of masters, in the plane: a part of a large arc over a wavy line, any nodes moved at random.
struct InPlane : VariedSkins {
  InPlane(CellType slave, CellType master, bool on_axis, bool actual, bool smoothing, unsigned seed)
      : VariedSkins{2, slave, master, on_axis, actual, smoothing, {}, {}, {}, {}, {}} {
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
    chain(master, 1, 1.62, 1.37, 0.2, masters);  // nearer: it hides a part of the others
    initial = coordinates;
    for (double& x : initial) x += uniform(random);
    for (std::size_t i = 2; i < coordinates.size(); i += 3) coordinates[i] = initial[i] = 0;
    for (std::size_t i = 0; seed % 3 == 0 && i < coordinates.size() / 3; ++i) offset.push_back(0.1 + 3 * uniform(random));
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
            skins.fading = seed % 3 == 1 ? 1 : 0;      // the cover ends within such a band
            if (seed % 2 == 0) skins.steep_angle = 3;  // most couples count by a share
            const std::string what = "seed " + std::to_string(seed);
            const VariedSkins::Sum at = skins.evaluate(true);
            const double largest = largest_of(at.gradient), largest_second = largest_of(at.hessian);
            EXPECT_GT(largest, 0.1);
            EXPECT_GT(largest_second, 0.1);
            if (!axis) expect_rigid_motions_change_nothing(skins, at, what);
            for (std::size_t i = 0; i < skins.size(); ++i) {
              if (i % 3 == 2) continue;
              double& x = skins.coordinates[i];
              const double middle = x;
              x = middle + step;
              const VariedSkins::Sum ahead = skins.evaluate(false);
              x = middle - step;
              const VariedSkins::Sum behind = skins.evaluate(false);
              x = middle;
              EXPECT_NEAR(at.gradient[i], (ahead.gap - behind.gap) / (2 * step), 1e-7 * largest) << i << ' ' << what;
              for (std::size_t j = 0; j < skins.size(); ++j)
                EXPECT_NEAR(at.hessian[i * skins.size() + j], (ahead.gradient[j] - behind.gradient[j]) / (2 * step),
                            1e-7 * largest_second)
                    << i << ' ' << j << ' ' << what;
            }
          }
}

/// A straight slave cell over a master that ends `beyond` behind it, with a gap that grows to 0.2 at that end.
VariedSkins aligned_ends(CellType slave, CellType master, double beyond, double fading) {
  VariedSkins skins{2, slave, master, false, false, false, {}, {}, {}, {}, {}};
  skins.fading = fading;
  skins.coordinates = {0, 0.1, 0, 1, 0.2, 0, 1 + beyond, 0, 0, -0.5, 0, 0};
  skins.slaves = {{0, 1}};
  skins.masters = {{2, 3}};
  const auto add_middle = [&](std::vector<std::int32_t>& cell) {
    const auto a = static_cast<std::size_t>(3 * cell[0]), b = static_cast<std::size_t>(3 * cell[1]);
    cell.push_back(static_cast<std::int32_t>(skins.size() / 3));
    for (std::size_t k = 0; k < 3; ++k)
      skins.coordinates.push_back(0.5 * (skins.coordinates[a + k] + skins.coordinates[b + k]));
  };
  if (catalog::cell(slave).order == 2) add_middle(skins.slaves[0]);
  if (catalog::cell(master).order == 2) add_middle(skins.masters[0]);
  skins.initial = skins.coordinates;
  return skins;
}

// The normal of the slave's end passes the master's end at `aligned`. There forces must not jump, or no iterate is in
// equilibrium where they push both ends together; beyond the band, and where the ends are aligned, the integral is the exact
// one.
TEST(GapVariation, ForcesDoNotJumpWhereTheEndsOfBothSkinsAreAligned) {
  constexpr double aligned = 0.02, width = 2e-3, far = 2 * width, near = 1e-7;
  for (const CellType slave : {CellType::SEG2, CellType::SEG3})
    for (const CellType master : {CellType::SEG2, CellType::SEG3}) {
      const auto at = [&](double beyond, double fading) {
        return aligned_ends(slave, master, aligned + beyond, fading).evaluate(false);
      };
      const auto jump = [](const VariedSkins::Sum& a, const VariedSkins::Sum& b) {
        double largest = 0;
        for (std::size_t i = 0; i < a.gradient.size(); ++i)
          largest = std::max(largest, std::abs(a.gradient[i] - b.gradient[i]));
        return largest;
      };
      EXPECT_GT(jump(at(-near, 0), at(near, 0)), 0.1);
      EXPECT_LT(jump(at(-near, width), at(near, width)), 2e3 * near);
      for (const double beyond : {-far, 0.0, far}) {
        EXPECT_NEAR(at(beyond, width).gap, at(beyond, 0).gap, 1e-14);
        if (beyond != 0) {
          EXPECT_LT(jump(at(beyond, width), at(beyond, 0)), 1e-13);
        }
      }
      for (double beyond = -width; beyond < 0; beyond += width / 10)  // never further from it than the band is wide
        EXPECT_NEAR(at(beyond, width).gap, at(beyond, 0).gap, 0.02 * width);
    }
}

/// A slave cell, with its neighbour, over masters that reach beyond it on some sides only; in space.
struct InSpace : VariedSkins {
  /// @param bend how far nodes are moved at random, and how much the surfaces are curved
  InSpace(CellType slave, CellType master, bool actual, bool smoothing, double bend, unsigned seed)
      : VariedSkins{3, slave, master, false, actual, smoothing, {}, {}, {}, {}, {}} {
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
    for (std::size_t i = 0; seed % 2 == 0 && i < coordinates.size() / 3; ++i) offset.push_back(0.1 + 0.1 * uniform(random));
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
      if (seed % 2 == 0) skins.steep_angle = 2;                               // most couples count by a share
      for (std::size_t c = 0; seed % 5 < 2 && c < skins.masters.size(); ++c)  // their border above goes on
        skins.mirrored.push_back(catalog::cell(master).family == Family::QUAD ? 1U << 2 : c % 2 == 1 ? 1U << 1 : 0);
      const VariedSkins::Sum at = skins.evaluate(true);
      const std::size_t n = at.gradient.size();
      const double largest = largest_of(at.gradient), largest_second = largest_of(at.hessian);
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
          const VariedSkins::Sum sum = skins.evaluate(false);
          skins.coordinates = middle;
          return sum;
        };
        const VariedSkins::Sum ahead = moved(step), behind = moved(-step), far_ahead = moved(4 * step),
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

/// Flat slave cells over flat masters that are not parallel to them.
InSpace flat_skins(CellType slave, CellType master, bool smooth, unsigned seed) {
  InSpace skins(slave, master, seed % 4 < 2, smooth, 0, seed);
  if (seed % 4 < 2) skins.initial = skins.coordinates;
  skins.degree = 20;  // differences, and maps that are not affine, ask for more than the flat ones
  const std::int32_t first_master = skins.masters[0][0];
  for (std::size_t i = 0; i < skins.size(); i += 3) {
    double &x = skins.coordinates[i], &y = skins.coordinates[i + 1], &z = skins.coordinates[i + 2];
    const bool of_slave = i < 3 * static_cast<std::size_t>(first_master);
    if (of_slave) x = 0.3 + 0.7 * x, y = 0.7 * y - 0.1;  // within what masters cover
    // not affine, with straight edges; in the chart of slaves of the second order lines would not be straight
    if (of_slave ? slave == CellType::QUAD4 : catalog::cell(master).family == Family::QUAD) y *= 1 + 0.1 * x;
    z += of_slave ? 0.2 * x - 0.1 * y : 0.05 * y;
  }
  return skins;
}

/// Derivatives against differences, along a direction that leaves all planes.
void expect_derivatives_of_differences(VariedSkins skins, const std::string& what) {
  const VariedSkins::Sum at = skins.evaluate(true), first = skins.evaluate(false);
  const std::size_t n = at.gradient.size();
  const double largest = largest_of(at.gradient), largest_second = largest_of(at.hessian);
  EXPECT_GT(largest, 0.02) << what;
  EXPECT_LT(asymmetry(at.hessian, n), 1e-12 * largest_second) << what;
  expect_rigid_motions_change_nothing(skins, at, what);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<double> along(n);
  for (double& d : along) d = uniform(random);
  const std::vector<double> middle = skins.coordinates;
  const auto moved = [&](double by) {
    for (std::size_t i = 0; i < n; ++i) skins.coordinates[i] = middle[i] + by * along[i];
    return skins.evaluate(false);
  };
  constexpr double step = 2e-7;
  const VariedSkins::Sum ahead = moved(step), behind = moved(-step);
  if (skins.slave_type != CellType::TRIA3 || skins.master_type != CellType::TRIA3) {
    EXPECT_EQ(ahead.in_one, 0U) << what;
  }
  double slope = 0;
  for (std::size_t i = 0; i < n; ++i) slope += at.gradient[i] * along[i];
  EXPECT_NEAR(slope, (ahead.gap - behind.gap) / (2 * step), 1e-7 * largest) << what;
  for (std::size_t j = 0; j < n; ++j) {
    double turn = 0;
    for (std::size_t i = 0; i < n; ++i) turn += at.hessian[j * n + i] * along[i];
    EXPECT_NEAR(turn, (ahead.gradient[j] - behind.gradient[j]) / (2 * step), 1e-7 * largest_second) << what;
    EXPECT_NEAR(at.gradient[j], first.gradient[j], 1e-12 * largest) << what;
  }
}

constexpr CellType kinds_in_space[] = {CellType::TRIA3, CellType::QUAD4, CellType::TRIA6, CellType::QUAD8, CellType::QUAD9};

// Where masters in one plane cover a flat slave cell it is integrated in one piece, and has the derivatives of what triangles
// leave as soon as nodes move.
TEST(GapVariation, FlatSkinsHaveTheirDerivativesInOnePiece) {
  unsigned seed = 600;
  for (const CellType slave : kinds_in_space)
    for (const CellType master : kinds_in_space) {
      const bool smooth = ++seed % 3 == 0;
      const InSpace skins = flat_skins(slave, master, smooth, seed);
      const std::string what = std::string(catalog::cell(slave).name) + " over " + std::string(catalog::cell(master).name) +
                               (smooth ? ", smooth, " : ", ") + std::to_string(seed);
      const VariedSkins::Sum at = skins.evaluate(true);
      EXPECT_EQ(at.traced, 0U) << what;
      EXPECT_GT(at.in_one, 3U) << what;
      expect_derivatives_of_differences(skins, what);
    }
}

// Masters in several planes have a kink, which moves: first derivatives alone need no triangles.
TEST(GapVariation, FlatSlavesOverMastersInSeveralPlanesNeedTrianglesForSecondDerivatives) {
  unsigned seed = 700;
  for (const CellType slave : kinds_in_space)
    for (const CellType master : kinds_in_space) {
      InSpace skins = flat_skins(slave, master, false, ++seed);
      for (auto i = 3 * static_cast<std::size_t>(skins.masters[0][0]); i < skins.size(); i += 3)
        skins.coordinates[i + 2] += 0.1 * std::abs(skins.coordinates[i] - 0.73) - 0.05 * std::abs(skins.coordinates[i] - 1.34);
      const std::string what = std::string(catalog::cell(slave).name) + " over " + std::string(catalog::cell(master).name);
      EXPECT_EQ(skins.evaluate(true).in_one, 0U) << what;
      EXPECT_EQ(skins.evaluate(false).traced, 0U) << what;
      expect_derivatives_of_differences(skins, what);
    }
}

// Where the cover ends within a slave cell, or the gap jumps, first derivatives hang on the lines as well.
TEST(GapVariation, FlatSlavesNeedTrianglesWhereTheCoverEndsOrTheGapJumps) {
  for (const CellType kind : kinds_in_space) {
    const std::string what(catalog::cell(kind).name);
    EXPECT_EQ(InSpace(kind, kind, true, false, 0, 3).evaluate(false).in_one, 0U) << what;
    InSpace jumps = flat_skins(kind, kind, false, 2);
    std::map<std::int32_t, std::int32_t> raised;  // the nodes of the last square, once more
    for (std::vector<std::int32_t>& cell : jumps.masters) {
      double middle = 0;
      for (const std::int32_t node : cell)
        middle += jumps.coordinates[3 * static_cast<std::size_t>(node)] / double(cell.size());
      for (std::int32_t& node : cell) {
        if (middle < 1.34) continue;
        const auto [at, added] = raised.try_emplace(node, static_cast<std::int32_t>(jumps.size() / 3));
        for (std::size_t k = 0; added && k < 3; ++k) {
          const std::size_t from = 3 * static_cast<std::size_t>(node) + k;
          jumps.coordinates.push_back(jumps.coordinates[from] + (k == 2 ? 0.05 : 0));
          jumps.initial.push_back(jumps.initial[from]);
        }
        if (added && !jumps.offset.empty()) jumps.offset.push_back(0);
        node = at->second;
      }
    }
    const VariedSkins::Sum at = jumps.evaluate(false);
    EXPECT_GT(at.in_one, 0U) << what;
    EXPECT_GT(at.traced, 0U) << what;
    expect_derivatives_of_differences(jumps, what + ", a jump");
  }
}

// The same skins bent by 1e-7 and by 1e-5 of their cells: edges count as straight there, and as curved here. A middle node
// moves the border of a cover in both, or no iterate is in equilibrium where forces push an edge straight.
TEST(GapVariation, ForcesDoNotJumpWhereEdgesBecomeStraight) {
  unsigned seed = 500;
  for (const CellType slave : {CellType::TRIA3, CellType::TRIA6, CellType::QUAD8, CellType::QUAD9})
    for (const CellType master : {CellType::QUAD4, CellType::TRIA6, CellType::QUAD8, CellType::QUAD9}) {
      ++seed;
      const auto bent = [&](double bend) { return InSpace(slave, master, false, false, bend, seed).evaluate(false); };
      const VariedSkins::Sum straight = bent(1e-7), curved = bent(1e-5);
      EXPECT_GT(largest_of(straight.gradient), 0.1);
      for (std::size_t i = 0; i < straight.gradient.size(); ++i)
        EXPECT_NEAR(straight.gradient[i], curved.gradient[i], 20 * 1e-5)
            << catalog::cell(slave).name << catalog::cell(master).name;
    }
}

// Two masters whose bulging ends lie over each other, mirrored to the middle of the slave: lines that part the one coincide
// with lines that part the other. Beside that place, by a hair, they do not.
TEST(GapVariation, ForcesDoNotJumpWhereLinesOfTwoMastersCoincide) {
  for (const CellType kind : {CellType::QUAD8, CellType::QUAD9}) {
    const auto skins = [&](double shake) {
      VariedSkins skins{.dimension = 3,
                        .slave_type = CellType::QUAD4,
                        .master_type = kind,
                        .axis = false,
                        .current = true,
                        .smooth = false,
                        .coordinates = {},
                        .initial = {},
                        .slaves = {},
                        .masters = {}};
      std::mt19937 random(9);
      std::uniform_real_distribution<double> uniform(-shake, shake);
      const auto add = [&](double x, double y, double z) {
        skins.coordinates.insert(skins.coordinates.end(), {x + uniform(random), y + uniform(random), z});
        return static_cast<std::int32_t>(skins.coordinates.size() / 3) - 1;
      };
      skins.slaves = {{add(-0.5, -0.4, 0), add(-0.5, 0.4, 0), add(0.5, 0.4, 0), add(0.5, -0.4, 0)}};
      for (const double side : {-1.0, 1.0}) {
        const double end = -0.02 * side, bulge = 0.03 * side, z = -0.1 + 0.02 * side;
        std::vector<std::int32_t> cell{add(end, -0.5, z),
                                       add(side, -0.5, z),
                                       add(side, 0.5, z),
                                       add(end, 0.5, z),
                                       add((end + side) / 2, -0.5, z),
                                       add(side, 0, z),
                                       add((end + side) / 2, 0.5, z),
                                       add(end - bulge, 0, z)};
        if (side < 0) cell = {cell[1], cell[0], cell[3], cell[2], cell[4], cell[7], cell[6], cell[5]};
        if (kind == CellType::QUAD9) cell.push_back(add((end + side) / 2 - bulge / 2, 0, z));
        skins.masters.push_back(cell);
      }
      skins.initial = skins.coordinates;
      return skins;
    };
    const VariedSkins::Sum at = skins(0).evaluate(false);
    EXPECT_EQ(at.in_one, 0U);
    for (const double shake : {1e-13, 1e-10, 1e-7}) {
      const VariedSkins::Sum beside = skins(shake).evaluate(false);
      for (std::size_t i = 0; i < at.gradient.size(); ++i)
        EXPECT_NEAR(at.gradient[i], beside.gradient[i], 1e-10 + 20 * shake) << catalog::cell(kind).name << shake << ' ' << i;
    }
  }
}

}  // namespace
}  // namespace lacon
