// Gaps, couplings and coverage of a contact zone, from meshes of mixed cells.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>

#include "skins.hpp"

namespace lacon {
namespace {

/// Everything that an update gives.
struct Found {
  std::vector<double> patches, cells, coupling, records;
  std::vector<std::int64_t> rejected;
  bool operator==(const Found&) const = default;
};

Found update(const Skins& skins) {
  Registry registry;
  ContactGeometry geometry(skins.mesh, skins.model, skins.contact, registry);
  std::vector<ZonePairing> records;
  geometry.update(skins.displacement, &records);
  Found found;
  for (std::size_t p = 0; p < geometry.n_patches(); ++p)
    found.patches.insert(found.patches.end(), {geometry.gap(p), geometry.covered(p), geometry.whole(p), geometry.coverage(p)});
  for (const ContactGeometry::Cell& cell : geometry.cells())
    found.cells.insert(found.cells.end(), {static_cast<double>(cell.slave), static_cast<double>(cell.master), cell.gap,
                                           static_cast<double>(cell.coupling)});
  found.coupling = geometry.coupling();
  found.rejected.assign(geometry.rejected().begin(), geometry.rejected().end());
  EXPECT_EQ(records.size(), 1U);
  const ZonePairing& record = records.front();
  EXPECT_EQ(record.gap.size(), record.pairing.cells.size());
  EXPECT_EQ(record.gap.size(), geometry.cells().size());
  EXPECT_EQ(record.point_gap.size(), record.pairing.cells.weight.size());
  for (const std::vector<double>* values : {&record.point_gap, &record.gap, &record.measure, &record.pairing.cells.weight,
                                            &record.pairing.cells.slave_point, &record.pairing.cells.vertex})
    found.records.insert(found.records.end(), values->begin(), values->end());
  return found;
}

TEST(ContactGeometry, MixedSkinsThatArePlaneAndParallelAreCoveredAndHaveOneGap) {
  const Found found = update({13, 17, false});
  for (std::size_t p = 0; p < found.patches.size(); p += 4) {
    EXPECT_NEAR(found.patches[p], 0.1, 1e-14);      // gap
    EXPECT_NEAR(found.patches[p + 3], 1.0, 1e-12);  // covered fraction
  }
  // sum of C over the nodes of both sides: the slave's area along its normal -e_z is taken away, and given to the master
  double slave = 0, area = 0;
  for (std::size_t i = 2; i < found.coupling.size(); i += 3) (found.coupling[i] > 0 ? slave : area) += found.coupling[i];
  EXPECT_NEAR(slave, 1.0, 1e-12);
  EXPECT_NEAR(area, -1.0, 1e-12);
  for (const double gap : std::span(found.records).first(100)) EXPECT_NEAR(gap, 0.1, 1e-14);
}

TEST(ContactGeometry, TheBitsDoNotDependOnTheNumberOfThreads) {
  // enough slave cells for several blocks, cells of both kinds in each of them; bent, so that nothing is exact
  for (const bool smooth : {false, true}) {
    Skins skins(16, 13, smooth);
    std::mt19937 random(12);
    std::uniform_real_distribution<double> uniform(-0.004, 0.004);
    for (double& u : skins.displacement) u = uniform(random);
    const Found alone = update(skins);
    EXPECT_GT(alone.cells.size(), 4 * 500U);
    for (const char* threads : {"1", "2", "3", "5"}) {
      setenv("LACON_THREADS", threads, 1);
      const Found found = update(skins);
      unsetenv("LACON_THREADS");
      EXPECT_TRUE(found == alone) << threads << " threads";
    }
  }
}

/// First derivatives of the gaps of all patches, (patches, nodes, 3).
std::vector<double> derivatives(const Skins& skins, std::int8_t order) {
  Registry registry;
  ContactGeometry geometry(skins.mesh, skins.model, skins.contact, registry);
  geometry.update(skins.displacement);
  std::vector<double> sum(geometry.n_patches() * skins.mesh.coordinates.size());
  for (const ContactGeometry::Variation& variation : geometry.vary(std::vector<std::int8_t>(geometry.n_patches(), order))) {
    const auto patch = static_cast<std::size_t>(skins.contact.slaves[static_cast<std::size_t>(variation.slave)].patch);
    for (std::size_t i = 0; i < variation.of_gap.gradient.size(); ++i)
      sum[patch * skins.mesh.coordinates.size() + 3 * static_cast<std::size_t>(variation.nodes[i / 3]) + i % 3] +=
          variation.of_gap.gradient[i];
  }
  return sum;
}

TEST(ContactGeometry, TheBitsOfDerivativesDoNotDependOnTheNumberOfThreads) {
  for (const bool smooth : {false, true}) {
    Skins skins(6, 5, smooth);
    std::mt19937 random(12);
    std::uniform_real_distribution<double> uniform(-0.004, 0.004);
    for (double& u : skins.displacement) u = uniform(random);
    const auto with = [&](const char* threads) {
      setenv("LACON_THREADS", threads, 1);
      Registry registry;
      ContactGeometry geometry(skins.mesh, skins.model, skins.contact, registry);
      geometry.update(skins.displacement);
      std::vector<double> all;
      for (const ContactGeometry::Variation& variation : geometry.vary(std::vector<std::int8_t>(geometry.n_patches(), 2))) {
        all.insert(all.end(), variation.of_gap.gradient.begin(), variation.of_gap.gradient.end());
        all.insert(all.end(), variation.of_gap.hessian.begin(), variation.of_gap.hessian.end());
      }
      unsetenv("LACON_THREADS");
      return all;
    };
    const std::vector<double> alone = with("1");
    EXPECT_GT(alone.size(), 1000U);
    for (const char* threads : {"2", "3"}) EXPECT_TRUE(with(threads) == alone) << threads << " threads";
  }
}

// As finely as iterates have asked for, so that gaps do not leap on the way back; what another process takes up has the same
// bits.
TEST(ContactGeometry, SlavesStayCutAsTheyWereUntilTheyAreAtRest) {
  Skins skins(3, 2, false);
  const auto twisted = [&](double by) {  // over a master that is moved aside, so that it ends under slave cells
    std::vector<double> displacement(skins.displacement.size(), 0.0);
    for (std::size_t node = 0; node < skins.mesh.n_nodes(); ++node) {
      const double x = skins.mesh.coordinates[3 * node], y = skins.mesh.coordinates[3 * node + 1];
      if (skins.mesh.coordinates[3 * node + 2] < 0)
        displacement[3 * node] = 0.21, displacement[3 * node + 1] = 0.1 * x;
      else
        displacement[3 * node + 2] = by * x * y;
    }
    return displacement;
  };
  Registry registry;
  const auto coverage_of = [&](ContactGeometry& geometry, double by) {
    geometry.update(twisted(by));
    std::vector<double> coverage;
    for (std::size_t p = 0; p < geometry.n_patches(); ++p) coverage.push_back(geometry.coverage(p));
    return coverage;
  };
  ContactGeometry straight(skins.mesh, skins.model, skins.contact, registry),
      before(skins.mesh, skins.model, skins.contact, registry), taken_up(skins.mesh, skins.model, skins.contact, registry);
  const std::vector<double> coarse = coverage_of(straight, 0.1);
  coverage_of(before, 0.8);
  const std::vector<double> fine = coverage_of(before, 0.1);
  EXPECT_NE(fine, coarse);
  taken_up.rest_at(twisted(0));
  taken_up.set_cuts(before.cuts());
  EXPECT_EQ(coverage_of(taken_up, 0.1), fine);
  before.rest_at(twisted(0.1));
  EXPECT_EQ(coverage_of(before, 0.1), coarse);
}

TEST(ContactGeometry, WhereSlaveAndMasterCoincideCouplingsAreTheDerivativesOfGaps) {
  for (const double gap : {0.0, 0.01}) {
    Skins skins(5, 7, false);
    for (std::size_t i = 2; i < skins.displacement.size(); i += 3)
      skins.displacement[i] = skins.mesh.coordinates[i] < 0 ? 0.1 - gap : 0;
    const std::vector<double> first = derivatives(skins, 1), with_second = derivatives(skins, 2);
    skins.contact.frozen_gap = true;
    const std::vector<double> couplings = derivatives(skins, 1);
    double apart = 0, frozen = 0, largest = 0;
    for (std::size_t i = 0; i < first.size(); ++i) {
      apart = std::max(apart, std::abs(first[i] - with_second[i]));
      frozen = std::max(frozen, std::abs(first[i] - couplings[i]));
      largest = std::max(largest, std::abs(first[i]));
    }
    EXPECT_LT(apart, 1e-12 * largest) << gap;
    // elsewhere the gap's share turns with the slave
    if (gap == 0)
      EXPECT_EQ(frozen, 0);
    else
      EXPECT_GT(frozen, 1e-4 * largest);
  }
}

TEST(ContactGeometry, DerivativesDoNotJumpWhereEdgesOfSlavesLieOnLinesOfMasters) {
  Skins skins(6, 6, false);
  std::vector<double>& u = skins.displacement;
  for (std::size_t i = 0; i < u.size(); i += 3) {
    const double x = skins.mesh.coordinates[i], y = skins.mesh.coordinates[i + 1];
    if (skins.mesh.coordinates[i + 2] == 0) continue;
    // masters twice as large, warped: lines and diagonals of both skins lie one over the other
    u[i] = x - 0.5, u[i + 1] = y - 0.5, u[i + 2] = 0.02 * std::sin(5 * x * y + 1);
  }
  const auto sum_over_patches = [&] {
    const std::vector<double> of_patches = derivatives(skins, 1);
    std::vector<double> sum(u.size());
    for (std::size_t i = 0; i < of_patches.size(); ++i) sum[i % u.size()] += of_patches[i];
    return sum;
  };
  const std::vector<double> at = sum_over_patches(), middle = u;
  double largest = 0;
  for (const double derivative : at) largest = std::max(largest, std::abs(derivative));
  std::mt19937 random(7);
  for (const double shake : {1e-14, 1e-13, 1e-12, 1e-11, 1e-10, 1e-9, 1e-8}) {
    std::uniform_real_distribution<double> uniform(-shake, shake);
    for (std::size_t i = 0; i < u.size(); ++i) u[i] = middle[i] + uniform(random);
    const std::vector<double> beside = sum_over_patches();
    for (std::size_t i = 0; i < u.size(); ++i)
      EXPECT_NEAR(beside[i], at[i], (1e-10 + 1e3 * shake) * largest) << shake << ' ' << i;
  }
}

TEST(ContactGeometry, MastersGoOnWhereFreeFacesAreFlush) {
  Skins skins(4, 3, false);
  for (std::size_t i = 2; i < skins.mesh.coordinates.size(); i += 3) skins.mesh.coordinates[i] = 0;
  const auto slave_moved = [&](double by) {
    std::vector<double> displacement(skins.displacement.size(), 0.0);
    for (std::size_t node = 0; node < 25; ++node) displacement[3 * node] = by;
    return displacement;
  };
  Registry registry;
  const auto covered = [&](const ContactGeometry& geometry) {
    double sum = 0;
    for (std::size_t p = 0; p < geometry.n_patches(); ++p) sum += geometry.covered(p);
    return sum;
  };
  ContactGeometry geometry(skins.mesh, skins.model, skins.contact, registry),
      taken_up(skins.mesh, skins.model, skins.contact, registry);
  geometry.find_ends({});
  taken_up.find_ends({});
  geometry.rest_at(slave_moved(0));
  geometry.update(slave_moved(1e-4));
  EXPECT_NEAR(covered(geometry), 1 - 1e-4, 1e-12);
  EXPECT_TRUE(geometry.kept().flush.empty());
  EXPECT_TRUE(geometry.go_on_where_flush());
  EXPECT_NEAR(covered(geometry), 1, 1e-12);
  EXPECT_FALSE(geometry.go_on_where_flush());
  const std::vector<std::int32_t> flush = geometry.kept().flush;
  EXPECT_EQ(flush.size(), 3 * (1 + 8U));  // eight of nine squares, one of which is two triangles, have an edge at a side
  taken_up.rest_at(slave_moved(0.01));    // where nothing is flush
  taken_up.keep({.left_out = {}, .in_front = {}, .flush = flush});
  taken_up.update(slave_moved(1e-4));
  EXPECT_EQ(taken_up.kept().flush, flush);
  EXPECT_NEAR(covered(taken_up), 1, 1e-12);
  // beyond a thousandth of a cell it is over with the next state at rest
  geometry.rest_at(slave_moved(5e-4));
  geometry.update(slave_moved(5e-4));
  EXPECT_NEAR(covered(geometry), 1 - 5e-4, 1e-12);
  geometry.rest_at(slave_moved(3e-4));
  geometry.update(slave_moved(3e-4));
  EXPECT_NEAR(covered(geometry), 1, 1e-12);
}

}  // namespace
}  // namespace lacon
