// Pairing in space. The slave is the lower skin of a body above it, its outward normal points down; masters look up.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <random>

#include "lacon/elements/reference.hpp"
#include "lacon/pairing/facet.hpp"
#include "lacon/pairing/normals.hpp"
#include "lacon/pairing/pairing.hpp"
#include "lacon/pairing/polygon.hpp"
#include "moved.hpp"
#include "skins_in_space.hpp"
#include "threads.hpp"

namespace lacon::test {
namespace {

TEST(PairingInSpace, PatchEquilibriumOnAffineFacetsOfEveryKind) {
  // METHOD.md D.2: measure of the couples = measure of the slave; nodal forces of a uniform pressure exact on both sides, for
  // every pair of kinds, apart, touching and overlapping, tilted and scaled
  std::mt19937 random(5);
  int trial = 0;
  for (const CellType s : kinds)
    for (const CellType m : kinds) {
      const double gap = trial % 3 == 0 ? 0.2 : trial % 3 == 1 ? 0.0 : -0.1;
      const auto jitter = [](CellType type) { return catalog::cell(type).family == Family::TRIA ? 0.2 : 0.0; };
      Skin3 slave = mesh({3, 4, s, false, jitter(s)}, sheared(0), random),
            master = mesh({5, 3, m, true, jitter(m)}, sheared(-gap), random);
      const Motion motion{0.3 * trial, 0.2 * trial, trial % 2 == 0 ? 1e-3 : 1e3, {1e-3, 2e-3, -1e-3}};
      motion(slave), motion(master);
      const Pairing found = pair(slave.view(), master.view());
      const Forces f = forces(slave, master, found.cells);
      const std::vector<double> on_slave = nodal_areas(slave), on_master = nodal_areas(master);
      const double area = sum(on_slave);
      EXPECT_NEAR(f.area, area, 1e-12 * area) << trial;
      EXPECT_NEAR(f.gap, gap * motion.scale * area, 1e-12 * motion.scale * area) << trial;
      EXPECT_LE(f.off_ray, 1e-11 * motion.scale) << trial;
      EXPECT_LE(largest_difference(f.slave, on_slave), 1e-12 * area) << trial;
      EXPECT_LE(largest_difference(f.master, on_master), 1e-12 * area) << trial;
      EXPECT_EQ(found.count(Rejection::hidden), 0);
      EXPECT_EQ(found.count(Rejection::no_image), 0);
      EXPECT_EQ(found.count(Rejection::facing_away), 0);
      ++trial;
    }
}

TEST(PairingInSpace, PatchEquilibriumOnDistortedQuadrangles) {
  // shape functions are rational, or worse, in the plane: the rule's degree follows the distortion
  std::mt19937 random(6);
  for (const CellType s : {CellType::QUAD4, CellType::QUAD8, CellType::QUAD9})
    for (const CellType m : {CellType::QUAD4, CellType::QUAD8, CellType::QUAD9, CellType::TRIA3}) {
      Skin3 slave = mesh({3, 3, s, false, 0.2}, plane(0), random), master = mesh({4, 5, m, true, 0.2}, plane(0), random);
      const Motion motion{0.7, 1.1, 10, {}};
      motion(slave), motion(master);
      const Pairing found = pair(slave.view(), master.view());
      const Forces f = forces(slave, master, found.cells);
      const std::vector<double> on_slave = nodal_areas(slave), on_master = nodal_areas(master);
      const double area = sum(on_slave);
      EXPECT_NEAR(f.area, area, 1e-12 * area);
      EXPECT_LE(largest_difference(f.slave, on_slave), 1e-10 * area);
      EXPECT_LE(largest_difference(f.master, on_master), 1e-10 * area);
      EXPECT_EQ(found.count(Rejection::no_image), 0);
    }
}

TEST(PairingInSpace, PatchEquilibriumWhereMidNodesAreOffTheMiddle) {
  // edges are straight and polygons exact, but the inverse of a quadratic map has a branch point near the facet
  std::mt19937 random(8);
  const CellType quadratic[] = {CellType::TRIA6, CellType::QUAD8, CellType::QUAD9};
  for (int trial = 0; trial < 5; ++trial)
    for (const CellType s : quadratic)
      for (const CellType m : quadratic) {
        Skin3 slave = mesh({2, 3, s, false, 0.15}, plane(0), random), master = mesh({3, 2, m, true, 0.15}, plane(0), random);
        slide_mid_nodes(slave, 0.12, random), slide_mid_nodes(master, 0.12, random);
        const Pairing found = pair(slave.view(), master.view());
        const Forces f = forces(slave, master, found.cells);
        EXPECT_NEAR(f.area, 1, 1e-12);
        EXPECT_LE(largest_difference(f.slave, nodal_areas(slave)), 1e-10);
        EXPECT_LE(largest_difference(f.master, nodal_areas(master)), 1e-10);
        EXPECT_EQ(found.count(Rejection::no_image), 0);
      }
}

TEST(PairingInSpace, PatchEquilibriumInSinglePrecision) {
  // edges that bulge by the round-off of a file are straight: nothing is lost but that round-off
  std::mt19937 random(9);
  for (const CellType s : {CellType::QUAD8, CellType::QUAD9})
    for (const CellType m : {CellType::TRIA6, CellType::QUAD8, CellType::QUAD9}) {
      Skin3 slave = hexahedron_cut(s, false, 0.5), master = mesh({4, 3, m, true, 0.2, -1, 1, -1, 1}, plane(0), random);
      const Motion motion{0.7, 0, 1, {}};
      motion(slave), motion(master);
      for (Skin3* skin : {&slave, &master})
        for (double& x : skin->coordinates) x = static_cast<float>(x);
      EXPECT_LE(patch_error(slave, master, {}), 2e-6);
    }
}

TEST(PairingInSpace, TrapezoidsOfTheHexahedronCutAreExact) {
  for (const CellType type : {CellType::QUAD4, CellType::QUAD8, CellType::QUAD9}) {
    Skin3 slave = hexahedron_cut(type, false, 0.5), master = hexahedron_cut(type, true, 0.4);
    const Pairing found = pair(slave.view(), master.view());
    const Forces f = forces(slave, master, found.cells);
    EXPECT_NEAR(f.area, 4, 4e-12);
    EXPECT_LE(largest_difference(f.slave, nodal_areas(slave)), 4e-10);
    EXPECT_LE(largest_difference(f.master, nodal_areas(master)), 4e-10);
  }
}

TEST(PairingInSpace, ErrorFallsWithTheDegreeAndTheChosenOneIsEnough) {
  // METHOD.md 5.4: on the whole of E1 the integral of a shape function is off by 4e-4 (QUAD4), 6e-3 (QUAD8) with degree 4, by
  // 2e-10 and 6e-9 with degree 14; on parts of it by less
  std::mt19937 random(31);
  for (const auto& [type, coarse] : {std::pair(CellType::QUAD4, 1e-6), std::pair(CellType::QUAD8, 1e-5)}) {
    Skin3 slave = hexahedron_cut(type, false, 0.5),
          master = mesh({4, 3, CellType::TRIA3, true, 0.24, -1, 1, -1, 1}, plane(0), random);
    double last = 1;
    for (const int degree : {4, 8, 14}) {
      const double error = patch_error(slave, master, {.degree = degree});
      EXPECT_LT(error, 0.02 * last) << degree;
      if (degree == 4) {
        EXPECT_GT(error, coarse);
      }
      last = error;
    }
    EXPECT_LT(last, 1e-8);
    EXPECT_LT(patch_error(slave, master, {}), 1e-10);
  }
}

/// What a patch of one slave cell has: its row of C (without the normal) by side and node, and its average gap.
struct Row {
  std::map<std::pair<char, std::int32_t>, double> entries;
  double gap = 0, area = 0;
};
std::vector<Row> rows(const Skin3& slave, const Skin3& master, const ContactCells& cells) {
  std::vector<Row> found(slave.surface.size());
  for_points(slave, master, cells, [&](std::size_t c, double w, const Point3& x, const Point3& y) {
    Row& row = found[cells.slave[c]];
    const auto on_slave = slave.surface.nodes[cells.slave[c]], on_master = master.surface.nodes[cells.master[c]];
    for (std::size_t i = 0; i < x.shape.size(); ++i) row.entries[{'s', on_slave[i]}] += w * x.shape[i];
    for (std::size_t i = 0; i < y.shape.size(); ++i) row.entries[{'m', on_master[i]}] += w * y.shape[i];
    row.gap += w * dot(y.x - x.x, x.normal);
    row.area += w;
  });
  for (Row& row : found)
    if (row.area > 0) row.gap /= row.area;
  return found;
}
struct Change {
  double entry = 0, gap = 0;  ///< the former relative to the largest entry
};
Change largest_change(const std::vector<Row>& before, const std::vector<Row>& after) {
  Change change;
  double most = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    Row difference = before[i];
    for (const auto& [key, value] : before[i].entries) most = std::max(most, std::abs(value));
    for (const auto& [key, value] : after[i].entries) difference.entries[key] -= value;
    for (const auto& [key, value] : difference.entries) change.entry = std::max(change.entry, std::abs(value));
    change.gap = std::max(change.gap, std::abs(before[i].gap - after[i].gap));
  }
  change.entry /= most;
  return change;
}

TEST(PairingInSpace, ShakenCoordinatesChangeNothingButTheLastDigits) {
  // 1e-13 of the size on every coordinate: no entry of C by more than 1e-11 max |C|, no gap by more than 1e-11 h. Affine facets
  // that match (edges coincide, and slivers come and go), match but for a small shift or turn, and do not match.
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  int trial = 0;
  for (const CellType type : kinds)
    for (const CellType other : {type, kinds[(trial + 1) % 5]})
      for (const double shift : {0.0, 1e-13, 1e-12, 1e-10, 1e-8, 1e-5}) {
        const int n = trial % 4 == 3 ? 5 : 4;
        std::mt19937 same = random;
        Skin3 slave = mesh({4, 4, type, false}, sheared(0), same);
        same = random;
        Skin3 master = mesh({n, n, other, true}, sheared(trial % 2 == 0 ? 0 : -0.1), same);
        Motion{shift, 0, 1, {shift, -0.3 * shift, 0}}(master);
        Motion{0.4, 0.6, 1, {}}(slave), Motion{0.4, 0.6, 1, {}}(master);
        const std::vector<Row> before = rows(slave, master, pair(slave.view(), master.view()).cells);
        for (int shake = 0; shake < 4; ++shake) {
          Skin3 s = slave, m = master;
          for (Skin3* skin : {&s, &m})
            for (double& c : skin->coordinates) c += 1e-13 * uniform(random);
          const Pairing found = pair(s.view(), m.view());
          const Change change = largest_change(before, rows(s, m, found.cells));
          EXPECT_LE(change.entry, 1e-11) << trial << " " << shift;
          EXPECT_LE(change.gap, 1e-11 * 0.25) << trial << " " << shift;
          EXPECT_EQ(found.count(Rejection::no_image), 0);
        }
        ++trial;
      }
}

/// A wavy surface.
Place3 wave(double z, double height, double phase) {
  return [=](double x, double y) { return Vec3{x, y, z + height * std::sin(5 * x + phase) * std::cos(4 * y - phase)}; };
}

TEST(PairingInSpace, TreeEqualsBruteForceOnCurvedSurfaces) {
  std::mt19937 random(8);
  for (int trial = 0; trial < 25; ++trial) {
    const CellType s = kinds[trial % 5], m = kinds[(trial / 5) % 5];
    Skin3 slave = mesh({4 + trial % 3, 5, s, false, 0.2}, wave(0, 0.04, 0.1 * trial), random, true);
    Skin3 master = mesh({5, 4 + trial % 4, m, true, 0.2, -0.1, 1.2, -0.2, 1.1}, wave(-0.02, 0.05, 0.3), random, true);
    if (trial % 2 == 1) slave.normals = nodal_normals(slave.view());
    PairingOptions brute;
    brute.brute_force = true;
    const Pairing a = pair(slave.view(), master.view()), b = pair(slave.view(), master.view(), brute);
    EXPECT_EQ(couples(a.cells), couples(b.cells)) << trial;
    EXPECT_EQ(a.rejected, b.rejected);
    EXPECT_GT(a.cells.size(), slave.surface.size());
    EXPECT_EQ(a.count(Rejection::no_image), 0) << trial;
    const Forces f = forces(slave, master, a.cells);
    const double area = sum(nodal_areas(slave));
    EXPECT_NEAR(f.area, area, 1e-5 * area) << trial;
    EXPECT_NEAR(sum(f.slave), f.area, 1e-12);
    EXPECT_NEAR(sum(f.master), f.area, 1e-12);
    if (slave.normals.empty()) {
      EXPECT_LE(f.off_ray, 1e-10);
    }
  }
}

TEST(PairingInSpace, TheBitsDoNotDependOnTheNumberOfThreads) {
  std::mt19937 random(41);
  for (const bool curved : {false, true}) {
    Skin3 slave =
        mesh({17, 15, curved ? CellType::QUAD8 : CellType::QUAD4, false, 0.2}, wave(0, curved ? 0.03 : 0, 0), random, true);
    Skin3 master = mesh({16, 19, CellType::TRIA3, true, 0.2, -0.1, 1.2}, wave(-0.1, curved ? 0.03 : 0, 1), random, true);
    for (double* c : {&slave.coordinates[3 * 50], &master.coordinates[3 * 70]}) *c = std::nan("");  // degenerate cells too
    const Pairing alone = pair(slave.view(), master.view());
    EXPECT_GT(alone.cells.size(), 600U);
    EXPECT_GT(alone.count(Rejection::degenerate_slave), 0);
    EXPECT_GT(alone.count(Rejection::degenerate_master), 0);
    test::expect_same_in_threads(alone, [&] { return pair(slave.view(), master.view()); });
    // parts of any size make the whole
    PairingInParts pairing(slave.view(), master.view());
    Pairing part, whole;
    whole.cells.dimension = 3;
    for (std::size_t first = 0, n = 1; first < slave.surface.size(); first += n, n += 7) {
      pairing.pair(first, std::min(first + n, slave.surface.size()), part);
      whole.append(part);
    }
    EXPECT_TRUE(whole.cells == alone.cells);
    EXPECT_EQ(whole.rejected, alone.rejected);
  }
}

/// Whether a point of the reference cell lies in a contact cell's polygon.
bool inside(const ContactCells& cells, std::size_t c, Vec2 p) {
  bool in = true;
  const std::int64_t first = cells.vertex_offset[c], n = cells.vertex_offset[c + 1] - first;
  for (std::int64_t i = 0; i < n; ++i) {
    const double *a = &cells.vertex[2 * (first + i)], *b = &cells.vertex[2 * (first + (i + 1) % n)];
    in = in && cross(Vec2{b[0] - a[0], b[1] - a[1]}, Vec2{p.x - a[0], p.y - a[1]}) >= 0;
  }
  return in;
}

TEST(PairingInSpace, AgreesWithRaysOnBrokenSurfaces) {
  // A heap of loose triangles, one above the other, some upside down, some apart, some that overlap the slave body: a ray from
  // any point of a slave facet meets what pairing says, or nothing.
  std::mt19937 random(18);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int trial = 0; trial < 30; ++trial) {
    Skin3 slave = mesh({3, 3, trial % 2 == 0 ? CellType::TRIA3 : CellType::QUAD4, false}, sheared(0), random), master;
    std::vector<std::array<Vec3, 3>> triangles;
    for (int t = 0; t < 40; ++t) {
      const double z = -0.5 + 0.02 * t, x = 1.4 * uniform(random) - 0.2, y = 1.4 * uniform(random) - 0.2;
      std::array<Vec3, 3> p;
      std::vector<std::int32_t> nodes;
      for (Vec3& q : p) {
        q = {x + 0.6 * uniform(random) - 0.3, y + 0.6 * uniform(random) - 0.3, z + 0.009 * uniform(random)};
        nodes.push_back(master.add_node(q));
      }
      triangles.push_back(p);
      master.surface.add_cell(CellType::TRIA3, nodes);
    }
    PairingOptions brute;
    brute.brute_force = true;
    const Pairing found = pair(slave.view(), master.view()), oracle = pair(slave.view(), master.view(), brute);
    EXPECT_EQ(couples(found.cells), couples(oracle.cells));
    EXPECT_EQ(found.rejected, oracle.rejected);
    int wrong = 0, hits = 0;
    for (int ray = 0; ray < 2000; ++ray) {
      const auto cell = static_cast<std::int32_t>(random() % slave.surface.size());
      double xi[2] = {uniform(random), uniform(random)};
      if (slave.surface.types[cell] == CellType::TRIA3)
        xi[1] *= 1 - xi[0];
      else
        xi[0] = 2 * xi[0] - 1, xi[1] = 2 * xi[1] - 1;
      const Vec3 x = evaluate(slave, cell, xi).x;
      std::int32_t nearest = -1;
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t t = 0; t < triangles.size(); ++t) {
        const auto& [a, b, c] = triangles[t];
        const auto area = [](Vec3 p, Vec3 q, Vec3 r) { return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x); };
        const double all = area(a, b, c), la = area(x, b, c), lb = area(a, x, c), lc = area(a, b, x);
        if (all <= 0 || la < 0 || lb < 0 || lc < 0) continue;  // upside down, or missed
        const double z = (la * a.z + lb * b.z + lc * c.z) / all;
        if (std::abs(z) < least) least = std::abs(z), nearest = static_cast<std::int32_t>(t);
      }
      std::int32_t said = -1;
      int times = 0;
      for (std::size_t c = 0; c < found.cells.size(); ++c)
        if (found.cells.slave[c] == cell && inside(found.cells, c, {xi[0], xi[1]})) said = found.cells.master[c], ++times;
      hits += nearest >= 0;
      wrong += said != nearest || times > 1;
    }
    EXPECT_EQ(wrong, 0) << trial;
    EXPECT_GT(hits, 200) << trial;
  }
}

TEST(PairingInSpace, DoesNotDependOnTheOrderOfCells) {
  std::mt19937 random(9);
  for (int trial = 0; trial < 20; ++trial) {
    const CellType s = kinds[trial % 5], m = kinds[(trial / 2) % 5];
    const bool curved = trial % 2 == 0;
    Skin3 slave = mesh({4, 3, s, false, 0.2}, wave(0, curved ? 0.03 : 0, 0), random, true);
    Skin3 master = mesh({3, 5, m, true, 0.2}, wave(-0.1, curved ? 0.03 : 0, 1), random, true);
    std::vector<std::int32_t> so, mo;
    Skin3 s2 = permuted(slave, so, random), m2 = permuted(master, mo, random);
    EXPECT_EQ(couples(pair(slave.view(), master.view()).cells), couples(pair(s2.view(), m2.view()).cells, so, mo)) << trial;
  }
}

/// Another numbering: nodes and cells shuffled, and another first node for each cell.
/// @param[out] number of each old node; cell i of the result is cell order[i]
Skin3 renumbered(const Skin3& skin, std::vector<std::int32_t>& number, std::vector<std::int32_t>& order, std::mt19937& random) {
  number.resize(skin.n_nodes());
  for (std::size_t i = 0; i < number.size(); ++i) number[i] = static_cast<std::int32_t>(i);
  std::shuffle(number.begin(), number.end(), random);
  Skin3 other = permuted(skin, order, random);
  for (std::size_t i = 0; i < number.size(); ++i)
    for (int d = 0; d < 3; ++d) {
      other.coordinates[3 * number[i] + d] = skin.coordinates[3 * i + d];
      if (!skin.normals.empty()) other.normals[3 * number[i] + d] = skin.normals[3 * i + d];
    }
  for (std::size_t c = 0; c < other.surface.size(); ++c) {
    const int nv = catalog::cell(other.surface.types[c]).n_vertices, first = static_cast<int>(random() % nv);
    const std::span<std::int32_t> nodes(other.surface.nodes.values.data() + other.surface.nodes.offset[c],
                                        other.surface.nodes[c].size());
    for (std::int32_t& node : nodes) node = number[node];
    std::rotate(nodes.begin(), nodes.begin() + first, nodes.begin() + nv);
    if (nodes.size() > static_cast<std::size_t>(nv))
      std::rotate(nodes.begin() + nv, nodes.begin() + nv + first, nodes.begin() + 2 * nv);
  }
  return other;
}

TEST(PairingInSpace, DoesNotDependOnNumbersOrFirstNodes) {
  // to 1e-11 on affine facets, where integration is exact; elsewhere polygons are cut in other triangles: the error of
  // quadrature
  std::mt19937 random(21);
  for (int trial = 0; trial < 30; ++trial) {
    const CellType s = kinds[trial % 5], m = kinds[(trial / 5) % 5];
    const bool curved = trial % 3 == 2, matching = trial % 3 == 0;
    std::mt19937 same = random;
    Skin3 slave = mesh({4, 3, s, false, matching ? 0 : 0.15}, wave(0, curved ? 0.02 : 0, 0), same, true);
    same = random;
    Skin3 master = mesh({matching ? 4 : 5, 3, m, true, matching ? 0 : 0.15}, wave(-0.1, curved ? 0.02 : 0, 1), same, true);
    random();
    if (curved && trial % 2 == 0) slave.normals = nodal_normals(slave.view());
    for (Skin3* skin : {&slave, &master}) Motion{0.2 * trial, 0.3, 1, {}}(*skin);
    std::vector<std::int32_t> sn, so, mn, mo;
    Skin3 s2 = renumbered(slave, sn, so, random), m2 = renumbered(master, mn, mo, random);
    const std::vector<Row> before = rows(slave, master, pair(slave.view(), master.view()).cells),
                           shuffled = rows(s2, m2, pair(s2.view(), m2.view()).cells);
    std::vector<Row> after(before.size());
    for (std::size_t c = 0; c < after.size(); ++c) after[so[c]] = shuffled[c];
    std::vector<Row> expected = before;
    for (Row& row : expected) {
      Row there = row;
      there.entries.clear();
      for (const auto& [key, value] : row.entries) there.entries[{key.first, (key.first == 's' ? sn : mn)[key.second]}] = value;
      row = there;
    }
    const Change change = largest_change(expected, after);
    EXPECT_LE(change.entry, curved ? 2e-11 : matching ? 1e-11 : 1e-10) << trial;
    EXPECT_LE(change.gap, 1e-11) << trial;
  }
}

TEST(PairingInSpace, TreeEqualsBruteForceOnBrokenCurvedSurfaces) {
  // several loose pieces of every kind on both sides, bent by up to 85 degrees, some with their backs turned, some behind
  // others, apart and overlapping
  std::mt19937 random(22);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::size_t cells = 0, hidden = 0, away = 0;
  for (int trial = 0; trial < 20; ++trial) {
    Skin3 slave, master;
    for (int piece = 0; piece < 8; ++piece) {
      const double bend = 1.5 * uniform(random), twist = uniform(random), height = 0.4 * uniform(random);
      const Place3 place = [&](double x, double y) {
        const double a = bend * (x - 0.5), r = std::abs(bend) < 0.1 ? 0 : 1 / bend;
        return r == 0 ? Vec3{x, y, height + twist * x * y}
                      : Vec3{0.5 + r * std::sin(a), y, height + r * (1 - std::cos(a)) + twist * (x - 0.5) * (y - 0.5)};
      };
      const bool is_slave = piece < 3;
      const double x = 0.5 * uniform(random), y = 0.5 * uniform(random);
      const bool up = is_slave ? false : random() % 4 != 0;
      Skin3 part = mesh({2 + static_cast<int>(random() % 3), 2, kinds[random() % 5], up, 0.15}, place, random, true);
      Motion{3 * uniform(random), 0.5 * uniform(random), 1, {x, y, 0}}(part);
      append(is_slave ? slave : master, part);
    }
    if (trial % 3 == 1) slave.normals = nodal_normals(slave.view());
    const Pairing a = pair(slave.view(), master.view()), b = pair(slave.view(), master.view(), {.brute_force = true});
    EXPECT_EQ(couples(a.cells), couples(b.cells)) << trial;
    // with the other reasons brute force rejects a few couples more, which meet only the pieces that stand for a bent facet
    EXPECT_EQ(a.count(Rejection::hidden), b.count(Rejection::hidden)) << trial;
    cells += a.cells.size();
    hidden += static_cast<std::size_t>(a.count(Rejection::hidden));
    away += static_cast<std::size_t>(a.count(Rejection::facing_away));
    std::vector<double> covered(slave.surface.size(), 0.0), whole = covered;
    for_points(slave, master, a.cells,
               [&](std::size_t c, double w, const Point3&, const Point3&) { covered[a.cells.slave[c]] += w; });
    for (std::size_t c = 0; c < whole.size(); ++c) {
      const Rule& rule = integration_rule(catalog::cell(slave.surface.types[c]).family, 100);
      for (int g = 0; g < rule.size(); ++g)
        whole[c] += rule.weights[g] * evaluate(slave, static_cast<std::int32_t>(c), &rule.points[2 * g]).jacobian;
      EXPECT_LE(covered[c], whole[c] * (1 + 1e-9)) << trial;
    }
  }
  EXPECT_GT(cells, 4000U);
  EXPECT_GT(hidden, 500U);
  EXPECT_GT(away, 100U);
}

/// A single facet, counter-clockwise seen from above if it looks up.
Skin3 facet_of(CellType type, std::vector<Vec3> nodes) {
  Skin3 skin;
  std::vector<std::int32_t> numbers;
  for (const Vec3 p : nodes) numbers.push_back(skin.add_node(p));
  skin.surface.add_cell(type, numbers);
  return skin;
}
Skin3 slave_square(double size = 1) {
  return facet_of(CellType::QUAD4, {{0, 0, 0}, {0, size, 0}, {size, size, 0}, {size, 0, 0}});
}

TEST(PairingInSpace, FindsIslandsUnderOneSlaveCell) {
  std::mt19937 random(10);
  Skin3 slave = slave_square();
  Skin3 master = mesh({1, 1, CellType::QUAD4, true, 0, 0.1, 0.3, 0.1, 0.9}, plane(-0.1), random);
  const Skin3 other = mesh({2, 2, CellType::TRIA3, true, 0, 0.5, 0.75, 0.2, 0.6}, plane(0.05), random);
  append(master, other);
  const Pairing found = pair(slave.view(), master.view());
  EXPECT_EQ(couples(found.cells).size(), 9U);
  EXPECT_NEAR(forces(slave, master, found.cells).area, 0.2 * 0.8 + 0.25 * 0.4, 1e-14);
}

TEST(PairingInSpace, NearerMasterHidesTheOther) {
  std::mt19937 random(11);
  Skin3 slave = slave_square();
  Skin3 master = mesh({1, 1, CellType::QUAD4, true, 0, -1, 2, -1, 2}, plane(-0.5), random);
  const auto shift = static_cast<std::int32_t>(master.n_nodes());
  for (const auto& [x, y] : {std::pair(0.25, 0.25), std::pair(0.75, 0.25), std::pair(0.5, 0.75)}) master.add_node({x, y, -0.1});
  master.surface.add_cell(CellType::TRIA3, std::vector<std::int32_t>{shift, shift + 1, shift + 2});
  const Pairing found = pair(slave.view(), master.view());
  std::vector<double> area(2, 0.0);
  for_points(slave, master, found.cells,
             [&](std::size_t c, double w, const Point3&, const Point3&) { area[found.cells.master[c]] += w; });
  EXPECT_NEAR(area[1], 0.125, 1e-14);
  EXPECT_NEAR(area[0], 0.875, 1e-14);
  EXPECT_EQ(found.count(Rejection::hidden), 1);
  // two identical masters: one of them
  Skin3 twice = mesh({1, 1, CellType::QUAD4, true}, plane(-0.5), random);
  twice.surface.add_cell(CellType::QUAD4,
                         std::vector<std::int32_t>(twice.surface.nodes[0].begin(), twice.surface.nodes[0].end()));
  const Pairing once = pair(slave.view(), twice.view());
  EXPECT_EQ(once.cells.master, std::vector<std::int32_t>{0});
  EXPECT_NEAR(forces(slave, twice, once.cells).area, 1, 1e-14);
}

TEST(PairingInSpace, HandlesTJunctionsAndManyMasters) {
  std::mt19937 random(12);
  Skin3 slave = mesh({2, 2, CellType::TRIA3, false, 0.3}, plane(0), random);
  Skin3 master = mesh({3, 1, CellType::QUAD4, true, 0, 0, 1, 0, 0.4}, plane(0), random);
  const Skin3 other = mesh({50, 40, CellType::QUAD4, true, 0, 0, 1, 0.4, 1}, plane(0), random);
  append(master, other);
  const Pairing found = pair(slave.view(), master.view());
  const Forces f = forces(slave, master, found.cells);
  EXPECT_NEAR(f.area, 1, 1e-12);
  EXPECT_LE(largest_difference(f.master, nodal_areas(master)), 1e-12);
}

TEST(PairingInSpace, CutsNonConvexMastersInTriangles) {
  Skin3 slave = slave_square();
  const double z = -0.2;
  for (int first = 0; first < 4; ++first) {
    std::vector<Vec3> corners{{0.1, 0.1, z}, {0.9, 0.2, z}, {0.35, 0.3, z}, {0.2, 0.9, z}};
    std::rotate(corners.begin(), corners.begin() + first, corners.end());
    Skin3 master = facet_of(CellType::QUAD4, corners);
    const Pairing found = pair(slave.view(), master.view());
    // the map of such a quadrangle is folded at its reflex corner: what has no image there is said, not guessed
    double polygons = 0;
    for (std::size_t c = 0; c < found.cells.size(); ++c)
      for (std::int64_t g = found.cells.offset[c]; g < found.cells.offset[c + 1]; ++g) polygons += found.cells.weight[g] * 0.25;
    double shoelace = 0;
    for (int i = 0; i < 4; ++i)
      shoelace += 0.5 * (corners[i].x * corners[(i + 1) % 4].y - corners[i].y * corners[(i + 1) % 4].x);
    EXPECT_TRUE(found.count(Rejection::no_image) > 0 || std::abs(polygons - shoelace) < 1e-14) << polygons << " " << shoelace;
    EXPECT_LE(polygons, shoelace + 1e-14);
  }
}

TEST(PairingInSpace, NamesEveryReasonOfRejection) {
  std::mt19937 random(13);
  Skin3 slave = slave_square();
  Skin3 back = mesh({1, 1, CellType::QUAD4, false}, plane(-0.1), random);
  const Pairing away = pair(slave.view(), back.view());
  EXPECT_EQ(away.cells.size(), 0U);
  EXPECT_EQ(away.count(Rejection::facing_away), 1);

  Skin3 thin = facet_of(CellType::TRIA3, {{0, 0, -0.1}, {1, 0, -0.1}, {0.5, 1e-15, -0.1}});
  EXPECT_EQ(pair(slave.view(), thin.view()).count(Rejection::degenerate_master), 1);
  Skin3 edge = facet_of(CellType::TRIA3, {{-1, -1, 0}, {2, -1, 0}, {0.5, 3e-16, 0}});
  EXPECT_EQ(pair(slave.view(), edge.view()).count(Rejection::sliver), 1);

  Skin3 good = mesh({1, 1, CellType::QUAD4, true}, plane(-0.1), random);
  Skin3 nan = good;
  nan.coordinates[4] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(pair(slave.view(), nan.view()).count(Rejection::degenerate_master), 1);
  const Pairing bad = pair(nan.view(), good.view());
  EXPECT_EQ(bad.count(Rejection::degenerate_slave), 1);
  EXPECT_EQ(bad.rejected, (std::vector<RejectedCouple>{{0, -1, Rejection::degenerate_slave}}));
  Skin3 folded = facet_of(CellType::QUAD4, {{0, 0, 0}, {0.2, 0.3, 0}, {1, 1, 0}, {1, 0, 0}});
  folded.coordinates[3] = 0.9;
  EXPECT_EQ(pair(folded.view(), good.view()).count(Rejection::degenerate_slave), 1);

  Skin3 chain;
  chain.surface.add_cell(CellType::SEG2, std::vector<std::int32_t>{chain.add_node({0, 0, 0}), chain.add_node({1, 0, 0})});
  EXPECT_THROW(pair(slave.view(), chain.view()), std::invalid_argument);
  Skin3 empty;
  EXPECT_EQ(pair(slave.view(), empty.view()).cells.size(), 0U);
  EXPECT_EQ(pair(empty.view(), slave.view()).cells.size(), 0U);
}

TEST(PairingInSpace, ForcesAndMomentsBalanceOnCurvedSkinsThatDoNotMatch) {
  // METHOD.md 5.4 (b): lambda C with a pressure of its own for each slave cell, the slave's normal or the interpolated one of
  // its nodes (LISSAGE); nodal forces on slave and master have no resultant and no moment, to 1e-12 of their size (times a
  // length)
  std::mt19937 random(25);
  std::uniform_real_distribution<double> uniform(0.1, 1);
  for (int trial = 0; trial < 25; ++trial) {
    const CellType s = kinds[trial % 5], m = kinds[(trial / 5) % 5];
    Skin3 slave = mesh({4, 4, s, false, 0.2}, wave(0, 0.06, 0.2 * trial), random, true),
          master = mesh({3, 5, m, true, 0.2, -0.2, 1.1, -0.1, 1.3}, wave(trial % 3 - 1, 0.05, 0.7), random, true);
    for (Skin3* skin : {&slave, &master}) Motion{0.3 * trial, 0.4, trial % 2 == 0 ? 1 : 1e3, {0.2, -0.1, 0.3}}(*skin);
    if (trial % 4 < 2) slave.normals = nodal_normals(slave.view());
    std::vector<double> lambda;
    for (std::size_t c = 0; c < slave.surface.size(); ++c) lambda.push_back(-uniform(random));
    const Pairing found = pair(slave.view(), master.view());
    std::vector<Vec3> on_slave(slave.n_nodes()), on_master(master.n_nodes());
    for_points(slave, master, found.cells, [&](std::size_t c, double w, const Point3& x, const Point3& y) {
      const auto slave_nodes = slave.surface.nodes[found.cells.slave[c]],
                 master_nodes = master.surface.nodes[found.cells.master[c]];
      Vec3 n = x.normal;
      if (!slave.normals.empty()) {
        n = {};
        for (std::size_t i = 0; i < x.shape.size(); ++i) {
          const double* const nodal = &slave.normals[3 * static_cast<std::size_t>(slave_nodes[i])];
          n = n + x.shape[i] * Vec3{nodal[0], nodal[1], nodal[2]};
        }
        n = (1 / norm(n)) * n;
      }
      const Vec3 f = (lambda[found.cells.slave[c]] * w) * n;  // on the slave: - lambda C = + lambda w phi n
      for (std::size_t i = 0; i < x.shape.size(); ++i) on_slave[slave_nodes[i]] = on_slave[slave_nodes[i]] + x.shape[i] * f;
      for (std::size_t i = 0; i < y.shape.size(); ++i) on_master[master_nodes[i]] = on_master[master_nodes[i]] - y.shape[i] * f;
    });
    Vec3 force{}, moment{};
    double size = 0, length = 0;
    for (const auto& [skin, forces_on] : {std::pair(&slave, &on_slave), std::pair(&master, &on_master)})
      for (std::size_t i = 0; i < forces_on->size(); ++i) {
        const Vec3 x = skin->node(static_cast<std::int32_t>(i)), f = (*forces_on)[i];
        force = force + f;
        moment = moment + cross(x, f);
        size += norm(f);
        length = std::max(length, norm(x));
      }
    EXPECT_GT(size, 0.1);
    EXPECT_LE(norm(force), 1e-12 * size) << trial;
    EXPECT_LE(norm(moment), 1e-12 * size * length) << trial;
  }
}

TEST(PairingInSpace, IntegratesQuadranglesThatCollapseToATriangle) {
  // two nodes in one place or three corners on a line, at any corner; flat and warped, straight and quadratic, with normals of
  // its own or of nodes; as slave and as master
  std::mt19937 random(24);
  const std::array<Vec3, 4> repeated{Vec3{0, 0, 0}, {1, 0, 0}, {0.2, 0.9, 0}, {0.2, 0.9, 0}},
      in_line{Vec3{0, 0, 0}, {1, 0, 0}, {0.6, 0.45, 0}, {0.2, 0.9, 0}};
  for (const auto& shape : {repeated, in_line})
    for (const CellType type : {CellType::QUAD4, CellType::QUAD8, CellType::QUAD9})
      for (int first = 0; first < 4; ++first)
        for (const double warp : {0.0, 0.05})
          for (const bool smooth : {false, true})
            for (const bool as_slave : {true, false}) {
              std::vector<Vec3> nodes(shape.begin(), shape.end());
              if (warp > 0) nodes[0].z = nodes[1].z = warp, nodes[2].z = nodes[3].z = -warp;
              if (warp > 0 && &shape != &repeated) nodes[1].z = -warp;
              std::rotate(nodes.begin(), nodes.begin() + first, nodes.end());
              if (as_slave) std::reverse(nodes.begin(), nodes.end());
              for (int i = 0; i < 4 && type != CellType::QUAD4; ++i) nodes.push_back(0.5 * (nodes[i] + nodes[(i + 1) % 4]));
              if (type == CellType::QUAD9) nodes.push_back(0.25 * (nodes[0] + nodes[1] + nodes[2] + nodes[3]));
              Skin3 collapsed = facet_of(type, nodes);
              Skin3 other = mesh({3, 3, CellType::TRIA3, as_slave, 0.2, -1, 2, -1, 2}, plane(as_slave ? -0.2 : 0.2), random);
              Skin3 &slave = as_slave ? collapsed : other, &master = as_slave ? other : collapsed;
              if (smooth) slave.normals = nodal_normals(slave.view());
              const Pairing found = pair(slave.view(), master.view());
              const Forces f = forces(slave, master, found.cells);
              EXPECT_EQ(found.count(Rejection::degenerate_slave) + found.count(Rejection::degenerate_master), 0);
              EXPECT_EQ(found.count(Rejection::no_image), 0);
              const double area = as_slave ? sum(nodal_areas(slave)) : 0.45;
              EXPECT_NEAR(f.area, area, warp > 0 ? 1e-3 * area : 1e-12) << as_slave << first << catalog::cell(type).name;
              EXPECT_NEAR(sum(f.slave), f.area, 1e-12);
              EXPECT_NEAR(sum(f.master), f.area, 1e-12);
              for (const double w : found.cells.weight) EXPECT_GT(w, 0);
              for (const double v : found.cells.vertex) EXPECT_TRUE(std::abs(v) <= 1 + 1e-6) << v;
            }
}

TEST(PairingInSpace, LeavesOutWhatIsFurtherThanTheLimit) {
  // squares of side 1 and 2 at the distance 1: in diameters of the larger one, 1 / sqrt(8); a nearer one behind the back of
  // the slave's body counts by its own distance
  std::mt19937 random(19);
  const double relative = 1 / std::sqrt(8.0);
  for (const double side : {-1.0, 1.0}) {
    Skin3 slave = slave_square();
    Skin3 master = mesh({1, 1, CellType::QUAD4, true, 0, -0.5, 1.5, -0.5, 1.5}, plane(side), random);
    const Pairing near = pair(slave.view(), master.view(), {.distance_limit = relative + 1e-6}),
                  far = pair(slave.view(), master.view(), {.distance_limit = relative - 1e-6});
    EXPECT_EQ(near.cells.size(), 1U);
    EXPECT_TRUE(near.rejected.empty());
    EXPECT_EQ(far.cells.size(), 0U);
    EXPECT_EQ(far.rejected, (std::vector<RejectedCouple>{{0, 0, side > 0 ? Rejection::too_deep : Rejection::too_far}}));
    for (const double none : {-1.0, 0.0})
      EXPECT_EQ(pair(slave.view(), master.view(), {.distance_limit = none}).cells.size(), 1U);
  }
  // what is too far hides nothing: every couple of a curved skin stands or falls by itself
  Skin3 slave = mesh({6, 6, CellType::QUAD8, false, 0.2}, wave(0, 0.1, 0), random, true);
  Skin3 master = mesh({5, 7, CellType::TRIA6, true, 0.2}, wave(-0.05, 0.1, 2), random, true);
  std::int64_t last = 0;
  for (const double limit : {0.01, 0.1, 0.3, 10.0}) {
    const Pairing found = pair(slave.view(), master.view(), {.distance_limit = limit});
    const auto n = static_cast<std::int64_t>(couples(found.cells).size());
    EXPECT_GT(n, last);
    EXPECT_EQ(found.count(Rejection::too_far) + found.count(Rejection::too_deep) > 0, limit < 1);
    last = n;
  }
}

TEST(PairingInSpace, LeavesOutOverlapsThatAreDeeperThanTheLimitAndTheMotion) {
  // as above; the outward normal of the slave points to z < 0
  std::mt19937 random(19);
  const double size = std::sqrt(8.0);
  for (const double side : {-1.0, 1.0}) {
    Skin3 slave = slave_square();
    Skin3 master = mesh({1, 1, CellType::QUAD4, true, 0, -0.5, 1.5, -0.5, 1.5}, plane(side), random);
    const auto rejected = [&](double limit, double closer, double sideways = 0) {  // since they were at rest, half of it each
      const std::vector<double> slave_rest = moved(slave.coordinates, {0, 0, 0.5 * closer}),
                                master_rest = moved(master.coordinates, {sideways, 0, -0.5 * closer});
      Surface of_slave = slave.view(), of_master = master.view();
      of_slave.rest = slave_rest;
      of_master.rest = master_rest;
      return pair(of_slave, of_master, {.depth_limit = limit}).rejected;
    };
    const std::vector<RejectedCouple> none, deep{{0, 0, Rejection::too_deep}};
    EXPECT_EQ(rejected(1 / size - 1e-6, 0), side > 0 ? deep : none);
    EXPECT_EQ(rejected(0.5 / size, 0.5 - 1e-6), side > 0 ? deep : none);
    EXPECT_EQ(rejected(0.5 / size, 0.5 + 1e-6), none);
    EXPECT_EQ(rejected(0.5 / size, -0.5 - 1e-6), side > 0 ? deep : none);
    EXPECT_EQ(rejected(0.5 / size, 0, 0.5 + 1e-6), side > 0 ? deep : none);
    EXPECT_EQ(rejected(1 / size + 1e-6, 0), none);
  }
}

TEST(PairingInSpace, LeavesOutTheOtherSideOfTheSameBody) {
  std::mt19937 random(23);
  Skin3 slave = slave_square();
  Skin3 master = mesh({1, 1, CellType::QUAD4, true, 0, -0.5, 1.5, -0.5, 1.5}, plane(1), random);
  const std::vector<std::int32_t> one(16, 7), other(16, 8);
  const auto rejected = [&](const std::vector<std::int32_t>& body, double at_rest) {
    const std::vector<double> rest = moved(master.coordinates, {0, 0, at_rest - 1});
    Surface of_slave = slave.view(), of_master = master.view();
    of_slave.body = one;
    of_master.body = body;
    of_master.rest = rest;
    return pair(of_slave, of_master).rejected;
  };
  const std::vector<RejectedCouple> none, through{{0, 0, Rejection::other_side}};
  const double limit = 0.25 * std::sqrt(8.0);
  EXPECT_EQ(rejected(one, 1), through);
  EXPECT_EQ(rejected(one, limit + 1e-6), through);
  EXPECT_EQ(rejected(one, limit - 1e-6), none);
  EXPECT_EQ(rejected(one, -1), none);
  EXPECT_EQ(rejected(other, 1), none);
}

TEST(PairingInSpace, CountsWallsBesideAnEdgeLessTheSteeperTheyAre) {
  for (const double angle : {0.0, 80.0, 84.9, 85.1, 88.0, 89.9}) {
    const double a = angle * std::numbers::pi / 180, c = std::cos(a), s = std::sin(a), z = -0.1;
    Skin3 slave = slave_square();
    Skin3 master = facet_of(CellType::QUAD4, {{0.5, 0, z}, {0.5 + c, 0, z - s}, {0.5 + c, 1, z - s}, {0.5, 1, z}});
    const Pairing found = pair(slave.view(), master.view(), {.steep_angle = 85}),
                  all = pair(slave.view(), master.view(), {.steep_angle = 90});
    ASSERT_EQ(all.cells.size(), 1U) << angle;
    ASSERT_EQ(found.cells.size(), 1U) << angle;
    const double t = std::min(c / std::cos(85 * std::numbers::pi / 180), 1.0);
    for (std::size_t p = 0; p < all.cells.weight.size(); ++p)
      EXPECT_NEAR(found.cells.weight[p], t * t * (3 - 2 * t) * all.cells.weight[p], 1e-15) << angle;
  }
}

TEST(PairingInSpace, WarpedFacetsApproachFlatOnesContinuously) {
  // a warp just above and just below what counts as flat
  std::mt19937 random(14);
  std::vector<Forces> found;
  for (const double height : {0.0, 1e-12, 1e-8}) {
    std::mt19937 same = random;
    Skin3 slave = mesh({3, 3, CellType::QUAD4, false}, wave(0, height, 0.4), same);
    Skin3 master = mesh({4, 4, CellType::QUAD4, true}, plane(0), same);
    found.push_back(forces(slave, master, pair(slave.view(), master.view()).cells));
    EXPECT_LE(largest_difference(found[0].slave, found.back().slave), 1e-12 + 10 * height * height);
    EXPECT_LE(largest_difference(found[0].master, found.back().master), 1e-12 + 10 * height);
  }
}

TEST(PairingInSpace, NearlyFlatTrapezoidsAreIntegratedAsWellAsFlatOnes) {
  // a warp that is small, but more than what counts as flat: four triangles a facet, and the degree that the distortion asks
  // for
  for (const double height : {1e-9, 1e-8}) {
    Skin3 slave = hexahedron_cut(CellType::QUAD4, false, 0.5), master = hexahedron_cut(CellType::QUAD4, true, 0.4);
    for (std::size_t i = 2; i < slave.coordinates.size(); i += 12) slave.coordinates[i] += height;  // two corners
    const Pairing found = pair(slave.view(), master.view());
    EXPECT_GT(found.cells.size(), pair(hexahedron_cut(CellType::QUAD4, false, 0.5).view(), master.view()).cells.size());
    const Forces f = forces(slave, master, found.cells);
    EXPECT_NEAR(f.area, 4, 4e-12);
    EXPECT_LE(largest_difference(f.slave, nodal_areas(slave)), 4e-10);
    EXPECT_LE(largest_difference(f.master, nodal_areas(master)), 4e-10 + height);
  }
}

TEST(PairingInSpace, CurvedFacetsOfMatchingSkinsCoverEachOther) {
  // A shell of a sphere on itself: all of it is covered, and the gap is zero. Curved edges along the border are clipped as four
  // chords, which leave 1/16 of the bulge: with h = 0.2 and a geodesic curvature of tan(0.4), 2/3 h^2 tan(0.4) / 8 / 16 of a
  // border as long as 4 times the side.
  std::mt19937 random(15);
  const Place3 sphere = [](double x, double y) {
    const double a = 0.8 * (x - 0.5), b = 0.8 * (y - 0.5);
    return Vec3{std::sin(a), std::cos(a) * std::sin(b), std::cos(a) * std::cos(b)};
  };
  for (const CellType type : kinds) {
    std::mt19937 same = random;
    Skin3 slave = mesh({4, 4, type, false}, sphere, same, true);
    same = random;
    Skin3 master = mesh({4, 4, type, true}, sphere, same, true);
    const Pairing found = pair(slave.view(), master.view());
    const Forces f = forces(slave, master, found.cells);
    const double area = sum(nodal_areas(slave));
    EXPECT_NEAR(f.area, area, 4 * 2.0 / 3 * 0.04 * std::tan(0.4) / 8 / 16) << catalog::cell(type).name;
    EXPECT_LE(f.area, (1 + 1e-9) * area) << catalog::cell(type).name;
    EXPECT_NEAR(f.gap, 0, 1e-10) << catalog::cell(type).name;
    EXPECT_EQ(found.count(Rejection::no_image), 0);
  }
}

TEST(PairingInSpace, StraightEdgesAreLinesWhateverTheOtherEdgesOfTheirFacetsAre) {
  // two squares side by side; their common edge bulges by half of what is straight, the outer edges of the second by a tenth
  std::mt19937 random(16);
  for (const CellType type : {CellType::TRIA6, CellType::QUAD8, CellType::QUAD9}) {
    Skin3 slave = mesh({1, 1, CellType::QUAD4, false, 0, 0.2, 0.8, 0.2, 0.8}, plane(-0.1), random);
    Skin3 master = mesh({2, 1, type, true}, plane(0), random);
    for (std::size_t i = 0; i < master.n_nodes(); ++i) {
      const Vec3 p = master.node(static_cast<std::int32_t>(i));
      if (p.y == 0.5 && p.x == 0.5) master.coordinates[3 * i] += 0.5 * PairingTolerances{}.straight;
      if (p.x == 0.75 && p.y != 0.5) master.coordinates[3 * i + 1] += p.y > 0 ? 0.1 : -0.1;
    }
    EXPECT_NEAR(forces(slave, master, pair(slave.view(), master.view()).cells).area, 0.36, 1e-13) << catalog::cell(type).name;
  }
}

TEST(Polygons, SubtractionLeavesWhatIntersectionDoesNotTake) {
  std::mt19937 random(16);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int trial = 0; trial < 200; ++trial) {
    const space::Polygon square{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    const auto triangle = [&] {
      std::vector<Vec2> p;
      for (int i = 0; i < 3; ++i) p.push_back({uniform(random), uniform(random)});
      if (cross(p[1] - p[0], p[2] - p[0]) < 0) std::swap(p[0], p[1]);
      space::Region region{square, {}};
      for (int i = 0; i < 3; ++i) {
        const Vec2 d = p[(i + 1) % 3] - p[i];
        region.halves.push_back({p[i], {-d.y, d.x}, 0});
        space::Polygon inside;
        space::clip(region.polygon, region.halves.back(), inside);
        region.polygon.swap(inside);
      }
      EXPECT_NEAR(space::double_area(region.polygon), cross(p[1] - p[0], p[2] - p[0]), 1e-14);
      return region;
    };
    const space::Region a = triangle(), b = triangle();
    std::vector<space::Region> rest;
    space::subtract(a, b, 0, rest);
    double left = space::double_area(space::intersection(a, b).polygon);
    if (space::separated(a, b, 0)) {
      EXPECT_LE(left, 1e-15);
    }
    for (const space::Region& part : rest) left += space::double_area(part.polygon);
    EXPECT_NEAR(left, space::double_area(a.polygon), 1e-14);
  }
}

TEST(Facets, HullHoldsEveryValueAndTouchesAtTheCorners) {
  std::mt19937 random(23);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const Family family : {Family::TRIA, Family::QUAD})
    for (int degree = 1; degree <= (family == Family::TRIA ? 2 : 3); ++degree)
      for (int trial = 0; trial < 20; ++trial) {
        double c[4][4];
        for (auto& row : c)
          for (double& value : row) value = uniform(random);
        const auto polynomial = [&](Vec2 p) {
          double value = 0;
          for (int i = 0; i <= degree; ++i)
            for (int j = 0; j <= (family == Family::TRIA ? degree - i : degree); ++j)
              value += c[i][j] * std::pow(p.x, i) * std::pow(p.y, j);
          return Vec3{value, -value, 1};
        };
        const std::vector<Vec3> net = space::hull(family, degree, polynomial);
        double low = 1e9, high = -1e9;
        for (const Vec3 v : net) {
          low = std::min(low, v.x), high = std::max(high, v.x);
          EXPECT_NEAR(v.z, 1, 1e-14);
          EXPECT_NEAR(v.x + v.y, 0, 1e-13);
        }
        for (int k = 0; k < 200; ++k) {
          Vec2 p{uniform(random), uniform(random)};
          if (family == Family::TRIA) p.x = 0.5 * (1 + p.x), p.y = 0.5 * (1 + p.y) * (1 - p.x);
          EXPECT_LE(polynomial(p).x, high + 1e-13);
          EXPECT_GE(polynomial(p).x, low - 1e-13);
        }
        if (degree == 1) {
          for (int k = 0; k < (family == Family::TRIA ? 3 : 4); ++k)
            EXPECT_TRUE(std::any_of(net.begin(), net.end(),
                                    [&](Vec3 v) { return std::abs(v.x - polynomial(space::probes(family)[k]).x) < 1e-14; }));
        }
      }
}

TEST(Facets, InverseFindsEveryPointOfStronglyBentFacets) {
  // the map is one to one on the cell, and folded close to it: Newton's way from the middle may end at the fold
  std::mt19937 random(18);
  std::uniform_real_distribution<double> uniform(-1, 1);
  int facets = 0;
  for (const CellType type : {CellType::TRIA6, CellType::QUAD8, CellType::QUAD9})
    for (int trial = 0; trial < 40; ++trial) {
      Skin3 skin = mesh({3, 3, type, true, 0.3}, plane(0), random);
      slide_mid_nodes(skin, 0.2, random);
      const Family family = catalog::cell(type).family;
      const Rule& grid = integration_rule(family, 100);
      for (std::size_t c = 0; c < skin.surface.size(); ++c) {
        std::vector<Vec3> nodes;
        for (const std::int32_t n : skin.surface.nodes[c]) nodes.push_back(skin.node(n));
        const space::Map2 map = space::project(space::interpolate(type, nodes), {1, 0, 0}, {0, 1, 0});
        const auto jacobian = [&](Vec2 p) { return cross(map(p).d1, map(p).d2); };
        bool sound = true;
        for (const Vec2 p : space::probes(family)) sound = sound && jacobian(p) > 1e-3;
        for (int g = 0; g < grid.size(); ++g) sound = sound && jacobian({grid.points[2 * g], grid.points[2 * g + 1]}) > 1e-3;
        if (!sound) continue;
        ++facets;
        for (int g = 0; g < grid.size(); ++g) {
          const Vec2 xi{grid.points[2 * g], grid.points[2 * g + 1]};
          const auto found = space::inverse(map, family, map(xi).x, 1e-14, 0.25);
          ASSERT_TRUE(found.has_value());
          EXPECT_NEAR(found->x, xi.x, 1e-9);
          EXPECT_NEAR(found->y, xi.y, 1e-9);
        }
      }
    }
  EXPECT_GT(facets, 500);
}

TEST(Facets, InverseFindsEveryPointOfConvexFacets) {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const CellType type : kinds) {
    Skin3 skin = mesh({3, 3, type, true, 0.3}, plane(0), random);
    for (std::size_t c = 0; c < skin.surface.size(); ++c) {
      std::vector<Vec3> nodes;
      for (const std::int32_t n : skin.surface.nodes[c]) nodes.push_back(skin.node(n));
      const space::Map3 map = space::interpolate(type, nodes);
      const Family family = catalog::cell(type).family;
      for (int k = 0; k < 20; ++k) {
        double xi[2] = {uniform(random), uniform(random)};
        if (family == Family::TRIA) xi[0] = 0.5 * (1 + xi[0]), xi[1] = 0.5 * (1 + xi[1]) * (1 - xi[0]);
        const Point3 p = evaluate(skin, static_cast<std::int32_t>(c), xi);
        EXPECT_LE(norm(p.x - map({xi[0], xi[1]}).x), 1e-15);
        const auto found = space::inverse(space::project(map, {1, 0, 0}, {0, 1, 0}), family, {p.x.x, p.x.y}, 1e-14, 0.25);
        ASSERT_TRUE(found.has_value());
        EXPECT_NEAR(found->x, xi[0], 1e-12);
        EXPECT_NEAR(found->y, xi[1], 1e-12);
        const space::Inverse inverse(space::project(map, {1, 0, 0}, {0, 1, 0}), family);
        const auto same = inverse({p.x.x, p.x.y}, 1e-14, 0.25);
        ASSERT_TRUE(same.has_value());
        EXPECT_NEAR(same->x, xi[0], 1e-12);
        EXPECT_NEAR(same->y, xi[1], 1e-12);
        EXPECT_NEAR(inverse.jacobian({xi[0], xi[1]}), p.jacobian, 1e-14);
      }
    }
  }
}

}  // namespace
}  // namespace lacon::test
