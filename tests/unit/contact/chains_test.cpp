// A chain of slave cells over a chain of masters in the plane: derivatives through the whole of ContactGeometry, the order of
// its sums, and what ContactState makes of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>

#include "lacon/operators/contact/contact_field.hpp"
#include "lacon/operators/contact/contact_state.hpp"

namespace lacon {
namespace {

/// Slaves above, masters below, both bent; every slave cell is a patch.
struct Chains {
  Mesh mesh;
  Model model;
  Contact contact;
  std::vector<double> displacement;

  /// @param quadratic whether a master is, by its number
  Chains(int n_slaves, int n_masters, CellType slave, const std::function<bool(int)>& quadratic) {
    mesh.dimension = 2;
    ContactZone zone;
    zone.slave = chain(n_slaves, 0, 1, 0.1, [&](int) { return slave == CellType::SEG3; });
    zone.master = chain(n_masters, 1.13, -0.17, 0, quadratic);
    zone.jacobian = "ACTUALISE";
    mesh.patches.emplace();
    for (const std::int32_t cell : zone.slave) {
      const auto patch = static_cast<std::int32_t>(mesh.patches->kind.size());
      zone.patches.push_back(patch);
      mesh.patches->kind.push_back(14);
      mesh.patches->cells.push_back(std::vector<std::int32_t>{cell});
      contact.slaves.push_back({cell, patch, 0, ""});
    }
    contact.zones.push_back(zone);
    model.dimension = 2;
    model.elements = {"D_PLAN/SEG2", "D_PLAN/SEG3"};
    for (const CellType type : mesh.types) model.element.push_back(type == CellType::SEG2 ? 0 : 1);
    displacement.assign(2 * mesh.n_nodes(), 0.0);
  }

  std::vector<std::int32_t> chain(int n, double from, double to, double height, const std::function<bool(int)>& quadratic) {
    const auto node = [&](double at) {
      const double x = from + (to - from) * at / n;
      mesh.coordinates.insert(mesh.coordinates.end(), {x, height + 0.05 * std::sin(3 * x + 20 * height), 0});
      return static_cast<std::int32_t>(mesh.n_nodes()) - 1;
    };
    std::vector<std::int32_t> cells;
    std::int32_t last = node(0);
    for (int c = 0; c < n; ++c) {
      std::vector<std::int32_t> nodes = {last, node(c + 1)};
      last = nodes[1];
      if (quadratic(c)) nodes.push_back(node(c + 0.5));
      cells.push_back(static_cast<std::int32_t>(mesh.n_cells()));
      mesh.add_cell(nodes.size() == 2 ? CellType::SEG2 : CellType::SEG3, nodes);
    }
    return cells;
  }
};

// First and second derivatives are those of differences whatever is switched on: smooth normals, offsets, the initial measure.
TEST(ChainsInContact, HaveTheDerivativesOfTheirGaps) {
  constexpr double step = 1e-6;
  for (const CellType type : {CellType::SEG2, CellType::SEG3})
    for (const bool smooth : {false, true})
      for (const bool with_offset : {false, true}) {
        Chains chains(3, 5, type, [](int c) { return c % 2 == 1; });
        chains.contact.smoothing = smooth;
        if (with_offset) chains.contact.zones[0].jacobian = "INITIAL";
        std::vector<double> offset;
        for (std::size_t node = 0; node < chains.mesh.n_nodes(); ++node)
          offset.push_back(0.01 + 0.004 * std::sin(static_cast<double>(node)));
        const std::size_t n = chains.displacement.size();
        Registry registry;
        ContactGeometry geometry(chains.mesh, chains.model, chains.contact, registry);
        if (with_offset) geometry.set_offsets({offset});
        struct Sums {
          std::vector<double> gap, gradient, hessian;  ///< of each patch
        };
        const auto sums_now = [&](std::int8_t order) {
          geometry.update(chains.displacement);
          Sums sums{std::vector<double>(3), std::vector<double>(3 * n), std::vector<double>(order > 1 ? 3 * n * n : 0)};
          for (const auto& of : geometry.vary(std::vector<std::int8_t>(3, order))) {
            const auto patch = static_cast<std::size_t>(chains.contact.slaves[static_cast<std::size_t>(of.slave)].patch);
            const auto at = [&](std::size_t i) { return 2 * static_cast<std::size_t>(of.nodes[i / 2]) + i % 2; };
            const std::size_t m = of.of_gap.gradient.size();
            sums.gap[patch] += of.of_gap.gap;
            for (std::size_t i = 0; i < m; ++i) {
              sums.gradient[patch * n + at(i)] += of.of_gap.gradient[i];
              for (std::size_t j = 0; order > 1 && j < m; ++j)
                sums.hessian[(patch * n + at(i)) * n + at(j)] += of.of_gap.hessian[i * m + j];
            }
          }
          return sums;
        };
        const Sums at = sums_now(2);
        for (std::size_t patch = 0; patch < 3; ++patch) {
          double measure = 0;  // at the geometry that the zone is measured at
          const auto nodes = chains.mesh.cells[patch];
          const auto a = chains.mesh.point(static_cast<std::size_t>(nodes[0])),
                     b = chains.mesh.point(static_cast<std::size_t>(nodes[1]));
          measure = std::hypot(a[0] - b[0], a[1] - b[1]);
          EXPECT_NEAR(at.gap[patch], geometry.gap(patch) * measure, 1e-3 * measure);
        }
        double largest = 0, largest_second = 0;
        for (const double value : at.gradient) largest = std::max(largest, std::abs(value));
        for (const double value : at.hessian) largest_second = std::max(largest_second, std::abs(value));
        for (std::size_t j = 0; j < n; ++j) {
          chains.displacement[j] = step;
          const Sums ahead = sums_now(1);
          chains.displacement[j] = -step;
          const Sums behind = sums_now(1);
          chains.displacement[j] = 0;
          for (std::size_t patch = 0; patch < 3; ++patch) {
            EXPECT_NEAR(at.gradient[patch * n + j], (ahead.gap[patch] - behind.gap[patch]) / (2 * step), 1e-6 * largest)
                << patch << ' ' << j << smooth << with_offset;
            for (std::size_t i = 0; i < n; ++i)
              EXPECT_NEAR(at.hessian[(patch * n + i) * n + j],
                          (ahead.gradient[patch * n + i] - behind.gradient[patch * n + i]) / (2 * step), 1e-6 * largest_second)
                  << patch << ' ' << i << ' ' << j << smooth << with_offset;
          }
        }
      }
}

// Where skins coincide, first derivatives do not hang on whether second ones are asked for too, whatever the order of the cells
// and however normals turn.
TEST(ChainsInContact, ThatCoincideHaveTheSameFirstDerivativesOfEitherOrder) {
  for (const CellType type : {CellType::QUAD4, CellType::TRIA6, CellType::QUAD8, CellType::QUAD9})
    for (const bool smooth : {false, true}) {
      // two cells side by side, curved, and the same again, looking the other way
      Mesh mesh;
      mesh.dimension = 3;
      Contact contact;
      ContactZone zone;
      zone.jacobian = "ACTUALISE";
      mesh.patches.emplace();
      const catalog::CellRow& row = catalog::cell(type);
      for (const bool of_slave : {true, false}) {
        std::map<std::pair<double, double>, std::int32_t> nodes;
        for (int cell = 0; cell < 2; ++cell) {
          std::vector<std::int32_t> own;
          for (int a = 0; a < row.n_nodes; ++a) {
            const double side = row.family == Family::TRIA && cell == 1 ? -1 : 1;  // turned about the longest edge
            const double s = row.nodes[2 * a], t = row.nodes[2 * a + 1];
            const double x = row.family == Family::TRIA ? (cell == 0 ? s : 1 - s) : side * s + 2 * cell,
                         y = row.family == Family::TRIA && cell == 1 ? 1 - t : t;
            const auto [at, fresh] = nodes.try_emplace({x, y}, static_cast<std::int32_t>(mesh.n_nodes()));
            if (fresh) mesh.coordinates.insert(mesh.coordinates.end(), {x, y, 0.1 * std::sin(x + 2 * y) + 0.05 * x * x});
            own.push_back(at->second);
          }
          if (of_slave) {  // looks down
            const auto v = static_cast<std::ptrdiff_t>(row.n_vertices);
            std::reverse(own.begin(), own.begin() + v);
            if (row.order == 2) std::reverse(own.begin() + v, own.begin() + 2 * v - 1);
          }
          const auto number = static_cast<std::int32_t>(mesh.n_cells());
          mesh.add_cell(type, own);
          (of_slave ? zone.slave : zone.master).push_back(number);
          if (!of_slave) continue;
          zone.patches.push_back(cell);
          mesh.patches->kind.push_back(0);
          contact.slaves.push_back({number, cell, 0, ""});
        }
      }
      contact.smoothing = smooth;
      contact.zones.push_back(zone);
      Model model;
      model.elements = {"3D/" + std::string(row.name)};
      model.element.assign(4, 0);
      Registry registry;
      ContactGeometry geometry(mesh, model, contact, registry);
      geometry.update(std::vector<double>(mesh.coordinates.size(), 0.0));
      const auto gradient = [&](std::int8_t order) {
        std::vector<double> sum(mesh.coordinates.size());
        for (const auto& of : geometry.vary(std::vector<std::int8_t>(2, order)))
          for (std::size_t i = 0; i < of.of_gap.gradient.size(); ++i)
            sum[3 * static_cast<std::size_t>(of.nodes[i / 3]) + i % 3] += of.of_gap.gradient[i];
        return sum;
      };
      const std::vector<double> first = gradient(1), with_second = gradient(2);
      double largest = 0;
      for (const double value : first) largest = std::max(largest, std::abs(value));
      EXPECT_GT(largest, 0.1);
      for (std::size_t i = 0; i < first.size(); ++i)
        EXPECT_NEAR(first[i], with_second[i], 1e-12 * largest) << row.name << smooth;
    }
}

// Sums are made kind by kind of masters in each block of slave cells, in the order of kinds, and not as masters come.
TEST(ChainsInContact, AreSummedUpKindByKind) {
  const Chains chains(100, 140, CellType::SEG2, [](int c) { return c % 3 != 0; });
  Registry registry;
  ContactGeometry geometry(chains.mesh, chains.model, chains.contact, registry);
  geometry.update(chains.displacement);
  std::vector<CellType> kinds;
  std::set<std::int32_t> slaves;
  for (const ContactGeometry::Cell& cell : geometry.cells()) {
    kinds.push_back(chains.mesh.types[static_cast<std::size_t>(cell.master)]);
    slaves.insert(cell.slave);
  }
  EXPECT_EQ(slaves.size(), 100u);
  EXPECT_TRUE(std::ranges::is_sorted(kinds));
  EXPECT_NE(kinds.front(), kinds.back());
}

// A skin of many blocks is measured, covered and recorded as its cells are one by one.
TEST(ChainsInContact, OfManyBlocksAreCoveredAndRecorded) {
  const Chains chains(400, 300, CellType::SEG2, [](int) { return false; });
  Registry registry;
  ContactGeometry geometry(chains.mesh, chains.model, chains.contact, registry);
  std::vector<ZonePairing> records;
  geometry.update(chains.displacement, &records);
  for (std::size_t p = 0; p < 400; ++p) {
    const auto nodes = chains.mesh.cells[p];
    const auto a = chains.mesh.point(static_cast<std::size_t>(nodes[0])),
               b = chains.mesh.point(static_cast<std::size_t>(nodes[1]));
    EXPECT_NEAR(geometry.whole(p), std::hypot(a[0] - b[0], a[1] - b[1]), 1e-14);
    EXPECT_NEAR(geometry.coverage(p), 1, 1e-12);
  }
  const ZonePairing& record = records.front();
  const ContactCells& cells = record.pairing.cells;
  ASSERT_EQ(record.gap.size(), cells.size());
  for (std::size_t c = 0; c < cells.size(); ++c) {
    double sum = 0, weight = 0;  // on straight cells the measure is constant
    for (auto p = static_cast<std::size_t>(cells.offset[c]); p < static_cast<std::size_t>(cells.offset[c + 1]); ++p) {
      sum += cells.weight[p] * record.point_gap[p];
      weight += cells.weight[p];
    }
    EXPECT_NEAR(record.gap[c], sum / weight, 1e-14) << c;
    EXPECT_NEAR(record.measure[c], weight / 2 * geometry.whole(static_cast<std::size_t>(cells.slave[c])), 1e-14) << c;
  }
}

/// A state whose bodies are the modulus alone.
struct InState : Chains {
  Registry registry;
  std::vector<std::uint8_t> free;

  using Chains::Chains;
  void add_bodies() {
    // one body cell over each slave: its edge and two nodes above
    for (std::size_t s = 0; s < contact.slaves.size(); ++s) {
      const auto cell = static_cast<std::size_t>(contact.slaves[s].cell);
      const std::vector<std::int32_t> skin(mesh.cells[cell].begin(), mesh.cells[cell].begin() + 2);
      std::vector<std::int32_t> nodes = skin;
      for (const std::int32_t below : {skin[1], skin[0]}) {
        const auto p = mesh.point(static_cast<std::size_t>(below));
        const double x = p[0], y = p[1] + 0.3;
        nodes.push_back(static_cast<std::int32_t>(mesh.n_nodes()));
        mesh.coordinates.insert(mesh.coordinates.end(), {x, y, 0});
      }
      mesh.add_cell(CellType::QUAD4, nodes);
      model.element.push_back(2);
    }
    model.elements.emplace_back("D_PLAN/QUAD4");
    for (std::size_t p = 0; p < mesh.patches->size(); ++p) mesh.patches->kind[p] = 7;
    displacement.assign(2 * mesh.n_nodes(), 0.0);
    free.assign(displacement.size(), 1);
  }
  ContactState state() {
    return {
        mesh, model, contact, registry, {.modulus = [](std::int32_t) { return std::optional<double>(1000.0); }, .free = free}};
  }
};

// What is opened behind an edge that is pulled goes by the patches that were in contact and have a row; others neither pull nor
// press.
TEST(ContactState, OpensBehindEdgesWhatWasInContactAlone) {
  InState chains(5, 7, CellType::SEG2, [](int) { return false; });
  chains.add_bodies();
  ContactState state = chains.state();
  for (std::size_t node = 0; node < 6; ++node) chains.displacement[2 * node + 1] = -0.12;
  state.update_geometry(chains.displacement);
  using enum Status;
  struct Case {
    std::vector<Status> before, after;
    std::vector<double> lambda;
    std::vector<Status> expected;
  };
  for (const auto& [before, after, lambda, expected] : {Case{{active, active, active, active, active},
                                                             {open, active, active, active, active},
                                                             {9, -1, -20, -20, -20},
                                                             {open, open, active, active, active}},
                                                        // the first was open before: its multiplier is of another state
                                                        Case{{open, active, active, active, active},
                                                             {open, active, active, active, active},
                                                             {9, -1, -20, -20, -20},
                                                             {open, active, active, active, active}},
                                                        // nothing is pulled where the patch stays
                                                        Case{{active, active, active, active, active},
                                                             {active, active, active, active, active},
                                                             {9, -1, -20, -20, -20},
                                                             {active, active, active, active, active}}}) {
    Patchwise patches(5);
    patches.status = after;
    patches.lambda = lambda;
    const std::int64_t opened = state.open_behind_edges(before, patches);
    EXPECT_EQ(patches.status, expected);
    EXPECT_EQ(opened, std::ranges::count(expected, open) - std::ranges::count(after, open));
  }
}

// A patch whose displacements are all imposed has no row, and none of its forces moves an edge.
TEST(ContactState, OpensNothingBehindPatchesThatAreLocked) {
  InState chains(5, 7, CellType::SEG2, [](int) { return false; });
  chains.add_bodies();
  std::ranges::fill(chains.free, 0);
  ContactState state = chains.state();
  for (std::size_t node = 0; node < 6; ++node) chains.displacement[2 * node + 1] = -0.12;
  state.update_geometry(chains.displacement);
  Patchwise patches(5);
  patches.status = {Status::open, Status::active, Status::active, Status::active, Status::active};
  patches.lambda = {9, -1, -20, -20, -20};
  EXPECT_EQ(state.open_behind_edges(std::vector<Status>(5, Status::active), patches), 0);
}

// The pattern that is asked for holds every entry that comes, no more pairs of nodes than second derivatives need; matrices are
// packed lower triangles.
TEST(ContactState, AsksForThePatternOfItsMatrices) {
  for (const bool second : {false, true}) {
    InState chains(3, 5, CellType::SEG2, [](int) { return false; });
    chains.add_bodies();
    ContactState state = chains.state();
    for (std::size_t node = 0; node < 4; ++node) chains.displacement[2 * node + 1] = -0.1;
    state.update_geometry(chains.displacement);
    Patchwise patches(3);
    patches.status.assign(3, Status::active);
    patches.lambda = {-3, -4, -5};
    state.linearise(patches, second);
    std::set<std::pair<std::int64_t, std::int64_t>> asked;
    for (const auto& [a, b] : state.coupled_vertices()) asked.insert(std::minmax(a, b));
    const auto first_patch = static_cast<std::int64_t>(chains.mesh.n_nodes());
    int of_nodes = 0;
    state.evaluate(patches, [&](const ContactTerm& term) {
      const std::size_t n = term.unknowns.size();
      ASSERT_EQ(term.matrix.size(), n * (n + 1) / 2);
      ASSERT_EQ(term.residual.size(), n);
      for (std::size_t i = 0, at = 0; i < n; ++i)
        for (std::size_t j = 0; j <= i; ++j, ++at) {
          const std::int64_t a = term.unknowns[i].vertex, b = term.unknowns[j].vertex;
          if (term.matrix[at] == 0 || a == b) continue;
          of_nodes += a < first_patch && b < first_patch;
          EXPECT_TRUE(asked.contains(std::minmax(a, b))) << a << ' ' << b;
        }
    });
    EXPECT_EQ(of_nodes > 0, second);
    const auto pairs = std::ranges::count_if(asked, [&](const auto& pair) { return pair.second < first_patch; });
    EXPECT_EQ(pairs > 0, second);
  }
}

// Normals of CONT_NOEU turn with the skins.
TEST(ContactField, HasTheNormalsOfSkinsAnyWayRound) {
  for (const double angle : {0.3, 1.2, 2.5}) {
    InState chains(2, 3, CellType::SEG2, [](int) { return false; });
    for (std::size_t i = 0; i < chains.mesh.coordinates.size(); i += 3) {
      const double x = chains.mesh.coordinates[i], y = i < 9 ? 0.1 : 0.0;  // straight
      chains.mesh.coordinates[i] = std::cos(angle) * x - std::sin(angle) * y;
      chains.mesh.coordinates[i + 1] = std::sin(angle) * x + std::cos(angle) * y;
    }
    chains.add_bodies();
    ContactState state = chains.state();
    state.update_geometry(chains.displacement);
    Patchwise patches(2);
    patches.status.assign(2, Status::active);
    patches.lambda = {-2, -2};
    state.linearise(patches, false);
    const Field field = nodal_contact_field(chains.mesh, chains.contact, state, patches);
    const auto at = [&](std::size_t row, const char* component) {
      return field.at(row, static_cast<std::size_t>(field.component(component)));
    };
    for (std::size_t row = 0; row < field.support.size(); ++row) {
      EXPECT_NEAR(at(row, "VX"), std::sin(angle), 1e-14);
      EXPECT_NEAR(at(row, "VY"), -std::cos(angle), 1e-14);
    }
    const PairedMasters masters = paired_masters(chains.mesh, chains.contact, state.geometry());
    double shares = 0;
    for (const double share : masters.share) shares += share;
    EXPECT_NEAR(shares, 2, 1e-12);  // both patches are covered
  }
}

}  // namespace
}  // namespace lacon
