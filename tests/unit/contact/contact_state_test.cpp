// Statuses, rows and forces of one patch over one master, in the plane.
#include "lacon/operators/contact/contact_state.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "lacon/catalog/messages.hpp"
#include "lacon/operators/contact/contact_field.hpp"

namespace lacon {
namespace {

constexpr double young = 1000.0;

/// A slave SEG3 of length 1 above a master SEG3 that reaches beyond it, each on a QUAD8; the slave's nodes are 8 to 15.
struct Touching : testing::Test {
  Mesh mesh;
  Model model;
  Contact contact;
  Registry registry;
  std::optional<double> modulus = young;         ///< of the slave's body
  std::optional<double> master_modulus = young;  ///< of the master's
  std::vector<std::uint8_t> free = std::vector<std::uint8_t>(32, 1);
  std::vector<double> displacement = std::vector<double>(32, 0.0);

  Touching() {
    mesh.dimension = 2;
    constexpr double corner[8][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.5, 0}, {1, 0.5}, {0.5, 1}, {0, 0.5}};
    for (const auto& [x, y] : corner) mesh.coordinates.insert(mesh.coordinates.end(), {2 * x - 0.5, y - 1, 0.0});
    for (const auto& [x, y] : corner) mesh.coordinates.insert(mesh.coordinates.end(), {x, y, 0.0});
    mesh.add_cell(CellType::SEG3, std::vector<std::int32_t>{2, 3, 6});
    mesh.add_cell(CellType::SEG3, std::vector<std::int32_t>{8, 9, 12});
    for (const std::int32_t first : {0, 8}) {
      std::vector<std::int32_t> nodes;
      for (std::int32_t i = 0; i < 8; ++i) nodes.push_back(first + i);
      mesh.add_cell(CellType::QUAD8, nodes);
    }
    Patches& patches = mesh.patches.emplace();
    patches.kind = {14};
    patches.cells.push_back(std::vector<std::int32_t>{1});
    patches.carriers.push_back(std::vector<std::int32_t>{12});
    model.dimension = 2;
    model.elements = {"D_PLAN/SEG3", "D_PLAN/QUAD8"};
    model.element = {0, 0, 1, 1};
    contact.zones.push_back({.slave_group = "SLAVE",
                             .master_group = "MASTER",
                             .slave = {1},
                             .master = {0},
                             .patches = {0},
                             .jacobian = "INITIAL",
                             .search = "RAPIDE",
                             .initial_status = "INTERPENETRE"});
    contact.slaves.push_back({1, 0, 0, "LACS32D"});
  }

  /// Beside the first, half as wide: the cells are SEG3 8 9 12 (x from 0 to 1) and 9 17 18 (x from 1 to 1.5).
  void add_second_patch() {
    for (const double x : {1.0, 1.5, 1.25}) mesh.coordinates.insert(mesh.coordinates.end(), {x, 0.0, 0.0});
    free.resize(38, 1);
    displacement.resize(38, 0.0);
    mesh.add_cell(CellType::SEG3, std::vector<std::int32_t>{9, 17, 18});
    mesh.add_cell(CellType::QUAD8, std::vector<std::int32_t>{9, 17, 10, 11, 18, 13, 14, 15});
    mesh.patches->kind.push_back(14);
    mesh.patches->cells.push_back(std::vector<std::int32_t>{4});
    mesh.patches->carriers.push_back(std::vector<std::int32_t>{18});
    model.element = {0, 0, 1, 1, 0, 1};
    contact.zones[0].slave = {1, 4};
    contact.zones[0].patches = {0, 1};
    contact.slaves.push_back({4, 1, 0, "LACS32D"});
  }

  ContactState state() {
    const auto of_body = [this](std::int32_t cell) { return cell == 2 ? master_modulus : modulus; };
    return {mesh, model, contact, registry, {.modulus = of_body, .free = free}};
  }
  /// Lift the upper body.
  void lift(double height) {
    for (std::size_t node = 8; node < 16; ++node) displacement[2 * node + 1] = height;
  }
  /// What evaluate() adds, summed up: the residual of each unknown (vertex, component).
  static std::map<std::pair<std::int64_t, int>, double> residuals(ContactState& state, const Patchwise& patches) {
    state.linearise(patches, false);
    std::map<std::pair<std::int64_t, int>, double> sums;
    state.evaluate(patches, [&](const ContactTerm& term) {
      for (std::size_t i = 0; i < term.unknowns.size(); ++i)
        sums[{term.unknowns[i].vertex, term.unknowns[i].component}] += term.residual[i];
    });
    return sums;
  }
};

TEST_F(Touching, TheInitialStatusIsWhatTheZoneAsksFor) {
  struct Case {
    const char* asked;
    double height;
    Status expected;
  };
  for (const auto& [asked, height, expected] :
       {Case{"INTERPENETRE", 0, Status::active}, Case{"INTERPENETRE", -0.1, Status::active},
        Case{"INTERPENETRE", 0.1, Status::open}, Case{"OUI", 0.1, Status::active}, Case{"NON", -0.1, Status::open}}) {
    contact.zones[0].initial_status = asked;
    ContactState now = state();
    lift(height);
    now.update_geometry(displacement);
    EXPECT_EQ(now.initial().status[0], expected) << asked << ' ' << height;
    EXPECT_EQ(now.initial().lambda[0], 0);
  }
}

TEST_F(Touching, APatchOfWhichLittleIsCoveredDoesNotStartActive) {
  ContactState now = state();
  for (const double coverage : {0.03, 0.01}) {
    for (std::size_t node = 8; node < 16; ++node) displacement[2 * node] = 1.5 - coverage;
    now.update_geometry(displacement);
    EXPECT_EQ(now.initial().status[0], coverage > 0.02 ? Status::active : Status::open) << coverage;
  }
}

// CONTACT_INIT='OUI': a gap that is far from closing stays open, unless all of the zone are as far.
TEST_F(Touching, OfPatchesThatAreToCloseThoseThatAreFarDoNotWhereOthersAreNear) {
  add_second_patch();
  contact.zones[0].initial_status = "OUI";
  ContactState now = state();
  lift(0.02);
  displacement[2 * 17 + 1] = 0.5, displacement[2 * 18 + 1] = 0.25;
  now.update_geometry(displacement);
  EXPECT_EQ(now.initial().status, (std::vector<Status>{Status::active, Status::open}));
  lift(1);
  displacement[2 * 17 + 1] = displacement[2 * 18 + 1] = 1;
  now.update_geometry(displacement);
  EXPECT_EQ(now.initial().status, (std::vector<Status>{Status::active, Status::active}));
}

TEST_F(Touching, APatchIsActiveWherePressureOrOverlapSaysSo) {
  ContactState now = state();
  // rho = E / 2 h = 500, both bodies give way: lambda + rho g <= 0 (METHOD.md 3.7)
  struct Case {
    double lambda, gap;
    Status expected;
  };
  for (const auto& [lambda, gap, expected] :
       {Case{-1, 0, Status::active}, Case{0, -0.01, Status::active}, Case{-1, 0.01, Status::open},
        Case{-20, 0.01, Status::active}, Case{3, -0.005, Status::open}, Case{3, -0.01, Status::active}}) {
    lift(gap);
    now.update_geometry(displacement);
    EXPECT_NEAR(now.geometry().gap(0), gap, 1e-15);
    for (const Status before : {Status::active, Status::open}) {
      Patchwise patches(1);
      patches.status[0] = before;
      patches.lambda[0] = lambda;
      EXPECT_EQ(now.update_statuses(patches), before != expected) << lambda << ' ' << gap;
      EXPECT_EQ(patches.status[0], expected) << lambda << ' ' << gap;
    }
  }
}

TEST_F(Touching, ToTakeContactAPatchIsCoveredByMoreThanToKeepIt) {
  ContactState now = state();
  struct Case {
    double coverage;
    Status before, expected;
  };
  for (const auto& [coverage, before, expected] :
       {Case{0.03, Status::open, Status::active}, Case{0.01, Status::open, Status::open},
        Case{0.01, Status::unpaired, Status::open}, Case{0.01, Status::active, Status::active},
        Case{1e-6, Status::active, Status::open}}) {
    lift(-0.1);  // inside the master, which ends at x = 1.5
    for (std::size_t node = 8; node < 16; ++node) displacement[2 * node] = 1.5 - coverage;
    now.update_geometry(displacement);
    Patchwise patches(1);
    patches.status[0] = before;
    now.update_statuses(patches);
    EXPECT_EQ(patches.status[0], expected) << coverage;
  }
}

// SANS_GROUP_NO, RESOLUTION='NON': whatever presses the patch, it stays open; what lies in its master is told beyond
// TOLE_INTERP.
TEST_F(Touching, APatchThatIsHeldOpenNeverCloses) {
  contact.zones[0].held_open = {0};
  contact.zones[0].initial_status = "OUI";
  contact.zones[0].resolution = "NON";
  contact.zones[0].overlap_tolerance = 0.05;
  ContactState now = state();
  for (const double gap : {0.1, 0.0, -0.04, -0.1}) {
    lift(gap);
    now.update_geometry(displacement);
    Patchwise patches = now.initial();
    EXPECT_EQ(patches.status[0], Status::open) << gap;
    EXPECT_EQ(now.update_statuses(patches), 0) << gap;
    const std::optional<UncheckedOverlap> overlap = now.unchecked_overlap(0);
    ASSERT_EQ(overlap.has_value(), gap == -0.1);
    EXPECT_NEAR(overlap ? overlap->depth : 0, overlap ? 0.1 : 0, 1e-15);
  }
}

// GLISSIERE='OUI': what was in contact at a state in equilibrium stays so under tension; what closes on the way may open again.
TEST_F(Touching, AContactThatGlidesDoesNotOpen) {
  for (const bool glides : {false, true})
    for (const bool closed : {false, true}) {
      contact.zones[0].gliding = glides ? "OUI" : "NON";
      ContactState now = state();
      lift(0.01);
      now.update_geometry(displacement);
      Patchwise patches(1);
      patches.status[0] = closed ? Status::active : Status::open;
      now.keep_gliding(patches);
      patches.status[0] = Status::active;
      patches.lambda[0] = 3;
      now.update_statuses(patches);
      EXPECT_EQ(patches.status[0], glides && closed ? Status::active : Status::open) << glides << closed;
    }
}

// DIST_ESCL, DIST_MAIT: gaps are smaller by the mean of the offset, at points by what it interpolates to, and derivatives
// belong to the same integral.
TEST_F(Touching, AnOffsetOfTheSkinsMakesGapsSmaller) {
  ContactState now = state();
  std::vector<double> offset(mesh.n_nodes(), 7.0);  // away from the slave it means nothing
  for (const std::size_t node : {8U, 9U, 12U}) offset[node] = 0.02 + 0.01 * mesh.coordinates[3 * node];
  now.set_offsets({offset});
  lift(0.05);
  now.update_geometry(displacement);
  EXPECT_NEAR(now.geometry().gap(0), 0.05 - 0.025, 1e-15);
  EXPECT_GT(now.geometry().smallest_gap(0), 0.05 - 0.03);
  EXPECT_LT(now.geometry().smallest_gap(0), 0.05 - 0.029);
  const auto variations = now.geometry().vary(std::vector<std::int8_t>{1});
  ASSERT_EQ(variations.size(), 1U);
  EXPECT_NEAR(variations[0].of_gap.gap, 0.025, 1e-15);  // times the length 1
  lift(0.02);
  now.update_geometry(displacement);
  EXPECT_EQ(now.initial().status[0], Status::active);  // an overlap, though the cells are apart
}

TEST_F(Touching, PressesOtherwiseWhereAPatchThatPressesHasChangedOrOneIsTo) {
  ContactState now = state();
  const auto lifted = [&](double height) {
    lift(height);
    now.update_geometry(displacement);
  };
  Patchwise patches = now.initial();
  for (const bool active : {false, true}) {
    patches.status[0] = active ? Status::active : Status::open;
    patches.lambda[0] = active ? -1e9 : 0;  // more than a gap of 0.02 can part
    lifted(0.01);
    const std::vector<double> gaps{now.geometry().gap(0)}, covered{now.geometry().covered(0)};
    EXPECT_FALSE(now.presses_otherwise(gaps, covered, patches));
    lifted(0.02);
    EXPECT_EQ(now.presses_otherwise(gaps, covered, patches), active);
    lifted(-0.02);  // it is to press
    EXPECT_TRUE(now.presses_otherwise(gaps, covered, patches));
  }
}

TEST_F(Touching, StatusesCompareAPressureWithTheStiffnessOfBothBodiesInSeries) {
  constexpr double gap = 1e-3;
  for (const double contrast : {1e-6, 1e-3, 1.0, 1e3, 1e6})
    for (const bool stiff_slave : {false, true}) {
      (stiff_slave ? modulus : master_modulus) = young * contrast;
      (stiff_slave ? master_modulus : modulus) = young;
      ContactState now = state();
      lift(gap);
      now.update_geometry(displacement);
      const double border = -gap / (1 / (young * contrast) + 1 / young);  // the pressure that closes this gap of h = 1
      for (const double factor : {0.99, 1.01}) {
        Patchwise patches(1);
        patches.status[0] = Status::active;
        patches.lambda[0] = factor * border;
        now.update_statuses(patches);
        EXPECT_EQ(patches.status[0], factor > 1 ? Status::active : Status::open) << contrast << ' ' << factor;
      }
    }
}

TEST_F(Touching, AMasterWithoutBodyIsRigid) {
  master_modulus.reset();
  ContactState now = state();
  lift(0.01);
  now.update_geometry(displacement);
  Patchwise patches(1);
  patches.status[0] = Status::active;
  for (const double lambda : {-9.9, -10.1}) {
    patches.lambda[0] = lambda;
    now.update_statuses(patches);
    EXPECT_EQ(patches.status[0], lambda < -10 ? Status::active : Status::open);
  }
}

TEST_F(Touching, TouchingAndUnloadedAPatchStaysWhatItIs) {
  ContactState now = state();
  now.update_geometry(displacement);
  for (const Status before : {Status::active, Status::open}) {
    Patchwise patches(1);
    patches.status[0] = before;
    EXPECT_EQ(now.update_statuses(patches), 0);
    EXPECT_EQ(patches.status[0], before);
  }
}

TEST_F(Touching, WithoutMasterItIsUnpairedAndItsMultiplierGoesToZero) {
  ContactState now = state();
  for (std::size_t node = 8; node < 16; ++node) displacement[2 * node] = 10;
  now.update_geometry(displacement);
  Patchwise patches(1);
  patches.status[0] = Status::active;
  patches.lambda[0] = -3;
  EXPECT_EQ(now.update_statuses(patches), 1);
  EXPECT_EQ(patches.status[0], Status::unpaired);
  const auto sums = residuals(now, patches);
  ASSERT_EQ(sums.size(), 1U);
  EXPECT_EQ(sums.at({16, 0}), -3);  // the patch's vertex is behind the nodes
  EXPECT_TRUE(now.coupled_vertices().empty());
}

TEST_F(Touching, ForcesOnBothBodiesAreThePressureAndBalance) {
  ContactState now = state();
  lift(-0.01);
  now.update_geometry(displacement);
  Patchwise patches(1);
  patches.status[0] = Status::active;
  patches.lambda[0] = -6;
  const auto sums = residuals(now, patches);
  const std::vector<double> forces = now.forces(patches);
  double slave = 0, master = 0;
  for (std::int64_t node = 0; node < 16; ++node)
    for (int d = 0; d < 2; ++d) {
      const auto sum = sums.find({node, d});
      // residuals are of internal forces: contact pushes the other way
      EXPECT_NEAR(forces[static_cast<std::size_t>(2 * node + d)], sum == sums.end() ? 0.0 : -sum->second, 1e-14);
      if (d == 1) (node < 8 ? master : slave) += forces[static_cast<std::size_t>(2 * node + d)];
    }
  EXPECT_NEAR(slave, 6, 1e-13);  // pressure 6 on a length of 1 lifts the slave
  EXPECT_NEAR(master, -6, 1e-13);
  EXPECT_NEAR(sums.at({16, 0}), -0.01, 1e-15);  // G of the active patch
  const ZoneBalance balance = now.balance(patches).front();
  EXPECT_NEAR(balance.on_slave.y, 6, 1e-13);
  EXPECT_NEAR(balance.on_slave.y + balance.on_master.y, 0, 1e-13);
  EXPECT_NEAR(balance.moment.z, 0, 1e-13);
  EXPECT_EQ(balance.active, 1);
  EXPECT_NEAR(balance.covered, 1, 1e-14);
  EXPECT_NEAR(now.constraint_residual(patches), 0.01, 1e-15);
  EXPECT_EQ(now.n_constraints(patches), 1);
}

TEST_F(Touching, APatchWhoseDisplacementsAreAllImposedIsLockedAndKeepsItsMultiplier) {
  std::fill(free.begin(), free.end(), 0);
  ContactState now = state();
  lift(-0.01);
  now.update_geometry(displacement);
  EXPECT_TRUE(now.is_locked(0));
  Patchwise patches(1);
  patches.status[0] = Status::active;
  patches.lambda[0] = -6;
  EXPECT_EQ(now.n_constraints(patches), 0);
  EXPECT_EQ(residuals(now, patches).at({16, 0}), 0);
  EXPECT_EQ(now.held_overlap().count, 1);
  EXPECT_NEAR(now.held_overlap().gap, -0.01, 1e-15);
  free[2 * 9] = 1;  // sideways only: the row of a flat patch does not meet it
  ContactState sideways = state();
  sideways.update_geometry(displacement);
  EXPECT_TRUE(sideways.is_locked(0));
  free[2 * 9 + 1] = 1;
  ContactState freed = state();
  freed.update_geometry(displacement);
  EXPECT_FALSE(freed.is_locked(0));
}

TEST_F(Touching, PointsInsideTheMasterAreToldEarlierWhereNothingPushesThemOut) {
  ContactState now = state();
  for (const bool active : {false, true})
    for (const double depth : {-0.3, 0.0004, 0.004, 0.03, 0.045, 0.06}) {
      lift(-depth);
      now.update_geometry(displacement);
      EXPECT_NEAR(now.geometry().smallest_gap(0), -depth, 1e-15);
      Patchwise patches(1);
      patches.status[0] = active ? Status::active : Status::open;
      EXPECT_EQ(now.presses(0, patches), active);
      const std::optional<PiercedPatch> pierced = now.pierced(0, patches, false);
      ASSERT_EQ(pierced.has_value(), depth > (active ? 0.05 : 0.04)) << active << ' ' << depth;
      EXPECT_NEAR(pierced ? pierced->depth : depth, depth, 1e-14);  // h = 1
      EXPECT_EQ(now.pierced(0, patches, true).has_value(), depth > (active ? 0.05 : 0.0005)) << active << ' ' << depth;
      // a tenth of what has pressed, and nothing of what still does
      for (const double strain : {1e-9, 0.35, 10.0})
        EXPECT_EQ(now.missed(0, patches, strain).has_value(), !active && depth > std::max(0.005, 0.1 * strain)) << depth;
    }
  // turned: open in the average, one end inside
  lift(0.1);
  displacement[2 * 9 + 1] = -0.1;
  displacement[2 * 12 + 1] = 0;
  displacement[2 * 8 + 1] = 0.1 + 0.02;
  now.update_geometry(displacement);
  EXPECT_GT(now.geometry().gap(0), 0);
  EXPECT_LT(now.geometry().smallest_gap(0), -0.05);
  const std::optional<PiercedPatch> pierced = now.pierced(0, Patchwise(1), false);
  ASSERT_TRUE(pierced);
  EXPECT_EQ(pierced->gap, now.geometry().gap(0));
}

TEST_F(Touching, ABodyWithoutModulusIsRefused) {
  modulus.reset();
  try {
    state();
    FAIL() << "rho needs a modulus";
  } catch (const Error& error) {
    EXPECT_EQ(error.message().id, "EVOLUTION_2");
  }
}

TEST_F(Touching, ContElemHoldsWhatThePatchesCarry) {
  ContactState now = state();
  lift(-0.01);
  now.update_geometry(displacement);
  Patchwise patches(1);
  patches.status[0] = Status::active;
  patches.lambda[0] = -6;
  const Field field = contact_field(contact, now.geometry(), patches);
  EXPECT_EQ(field.components, (std::vector<std::string>{"CONT", "PRES", "JEU", "COEFSURF", "PRESCOOR"}));
  const Patchwise read = patches_of(field, mesh, contact, "RESU");
  EXPECT_EQ(read.status, patches.status);
  EXPECT_EQ(read.lambda, patches.lambda);
  const PairedMasters masters = paired_masters(mesh, contact, now.geometry());
  EXPECT_EQ(masters.offset, (std::vector<std::int64_t>{0, 1}));
  EXPECT_EQ(masters.cell, (std::vector<std::int32_t>{now.geometry().cells().front().master}));
  EXPECT_NEAR(masters.share.front(), 1, 1e-14);
  Field elsewhere = field;
  elsewhere.support = {0};
  EXPECT_THROW(patches_of(elsewhere, mesh, contact, "RESU"), Error);
}

TEST_F(Touching, ContElemHasAMarkerForTheGapOfAPatchWithoutMasterAlone) {
  ContactState now = state();
  now.update_geometry(displacement);
  Patchwise patches(1);
  patches.status[0] = Status::active;
  EXPECT_TRUE(contact_field(contact, now.geometry(), patches).present.empty());  // every value is there
  patches.status[0] = Status::unpaired;
  const Field field = contact_field(contact, now.geometry(), patches);
  for (std::size_t c = 0; c < field.components.size(); ++c)
    EXPECT_EQ(field.presence(0, c), field.components[c] == "JEU" ? Field::marker : Field::there) << field.components[c];
}

// The slave from x = -0.6 to 0.4, masters from -0.5 to 0.3 and from there to 1.5, all turned: lengths have no direction.
TEST_F(Touching, SharesOfMastersAreTheirPartsOfThePatch) {
  mesh.coordinates[3 * 6] = 0.3;
  for (const std::int32_t node : {8, 9, 12}) mesh.coordinates[3 * static_cast<std::size_t>(node)] -= 0.6;
  mesh.add_cell(CellType::SEG2, std::vector<std::int32_t>{2, 6});
  mesh.add_cell(CellType::SEG2, std::vector<std::int32_t>{6, 3});
  model.elements.emplace_back("D_PLAN/SEG2");
  model.element.insert(model.element.end(), {2, 2});
  contact.zones[0].master = {4, 5};
  for (const double angle : {0.0, 0.6, 2.0}) {
    Mesh turned = mesh;
    for (std::size_t node = 0; node < mesh.n_nodes(); ++node) {
      const double x = mesh.coordinates[3 * node], y = mesh.coordinates[3 * node + 1];
      turned.coordinates[3 * node] = std::cos(angle) * x - std::sin(angle) * y;
      turned.coordinates[3 * node + 1] = std::sin(angle) * x + std::cos(angle) * y;
    }
    ContactGeometry geometry(turned, model, contact, registry);
    geometry.update(displacement);
    const PairedMasters masters = paired_masters(turned, contact, geometry);
    ASSERT_EQ(masters.cell, (std::vector<std::int32_t>{4, 5}));
    EXPECT_NEAR(masters.share[0], 0.1, 1e-14);
    EXPECT_NEAR(masters.share[1], 0.8, 1e-14);
  }
}

TEST_F(Touching, CouplesWithoutMeasureCoverNothing) {
  // turned so that both skins lie on the axis of revolution, where lengths weigh nothing
  for (std::size_t node = 0; node < mesh.n_nodes(); ++node)
    std::tie(mesh.coordinates[3 * node], mesh.coordinates[3 * node + 1]) =
        std::pair(mesh.coordinates[3 * node + 1], -mesh.coordinates[3 * node]);
  model.elements = {"AXIS/SEG3", "AXIS/QUAD8"};
  ContactState now = state();
  now.update_geometry(displacement);
  ASSERT_FALSE(now.geometry().cells().empty());
  EXPECT_EQ(paired_masters(mesh, contact, now.geometry()).share, std::vector<double>{0});
}

// Zones may meet at a corner of the body: the normal there stands between those of its sides.
TEST_F(Touching, ANodeOfTwoZonesHasOneUnitNormal) {
  mesh.add_cell(CellType::SEG3, std::vector<std::int32_t>{9, 10, 13});  // the side at x = 1
  mesh.patches->kind.push_back(14);
  mesh.patches->cells.push_back(std::vector<std::int32_t>{4});
  mesh.patches->carriers.push_back(std::vector<std::int32_t>{13});
  model.element = {0, 0, 1, 1, 0};
  ContactZone side = contact.zones[0];
  side.slave = {4};
  side.patches = {1};
  contact.zones.push_back(side);
  contact.slaves.push_back({4, 1, 0, "LACS32D"});
  ContactState now = state();
  now.update_geometry(displacement);
  Patchwise patches(2);
  now.linearise(patches, false);
  const Field field = nodal_contact_field(mesh, contact, now, patches);
  ASSERT_EQ(field.support, (std::vector<std::int32_t>{8, 9, 10, 12, 13}));
  const double half = std::sqrt(0.5), expected[5][2] = {{0, -1}, {half, -half}, {1, 0}, {0, -1}, {1, 0}};
  for (std::size_t row = 0; row < 5; ++row)
    for (const auto& [axis, name] : {std::pair(0, "VX"), std::pair(1, "VY")})
      EXPECT_NEAR(field.at(row, static_cast<std::size_t>(field.component(name))), expected[row][axis], 1e-15) << row;
}

TEST_F(Touching, ContNoeuHoldsWhatThePatchesAroundANodeCarryAndTheForceOnIt) {
  add_second_patch();
  ContactState now = state();
  now.update_geometry(displacement);
  Patchwise patches(2);
  patches.status = {Status::active, Status::open};
  patches.lambda = {-6, 0};
  now.linearise(patches, false);
  const Field field = nodal_contact_field(mesh, contact, now, patches);
  EXPECT_EQ(field.components,
            (std::vector<std::string>{"CONT", "JEU", "PRES", "RN", "RNX", "RNY", "R", "RX", "RY", "VX", "VY"}));
  ASSERT_EQ(field.support, (std::vector<std::int32_t>{8, 9, 12, 17, 18}));
  const auto at = [&](std::size_t row, const char* component) {
    return field.at(row, static_cast<std::size_t>(field.component(component)));
  };
  // means weighted with the measures 1 and 1/2
  const double pressure[5] = {-6, -4, -6, 0, 0};
  double force = 0;
  for (std::size_t row = 0; row < 5; ++row) {
    EXPECT_NEAR(at(row, "PRES"), pressure[row], 1e-14) << row;
    EXPECT_EQ(at(row, "CONT"), pressure[row] != 0 ? 2 : 0) << row;
    EXPECT_NEAR(at(row, "JEU"), 0, 1e-15);
    EXPECT_NEAR(at(row, "VX"), 0, 1e-15);
    EXPECT_NEAR(at(row, "VY"), -1, 1e-15);
    EXPECT_NEAR(at(row, "RN"), std::abs(at(row, "RNY")), 1e-14);
    EXPECT_EQ(at(row, "RY"), at(row, "RNY"));
    force += at(row, "RNY");
  }
  EXPECT_NEAR(force, 6, 1e-13);                   // 6 over a length of 1, upwards on the slave
  EXPECT_NEAR(at(2, "RNY"), 6 * 2.0 / 3, 1e-13);  // quadratic shape functions: 1/6, 2/3, 1/6
  const auto stand_in = nodal_pressures(mesh, contact, now.geometry(), patches);
  ASSERT_EQ(stand_in.size(), 5U);
  EXPECT_EQ(stand_in[1].first, 9);
  EXPECT_NEAR(stand_in[1].second, -4, 1e-14);
}

TEST_F(Touching, PressuresAtNodesAreOfWhatWholePatchesCarry) {
  add_second_patch();
  ContactState now = state();
  for (std::size_t node = 8; node < 19; ++node) displacement[2 * node] = 1.5 - 0.25;  // the master ends at x = 1.5
  now.update_geometry(displacement);
  ASSERT_NEAR(now.geometry().coverage(0), 0.25, 1e-12);
  Patchwise patches(2);
  patches.status = {Status::active, Status::unpaired};
  patches.lambda = {-6, 0};
  now.linearise(patches, false);
  const Field field = nodal_contact_field(mesh, contact, now, patches);
  // 6 on a quarter of a patch of 1, beside one of 1/2 without a master
  const double pressure[5] = {-1.5, -1, -1.5, 0, 0};
  for (std::size_t row = 0; row < 5; ++row)
    EXPECT_NEAR(field.at(row, static_cast<std::size_t>(field.component("PRES"))), pressure[row], 1e-12) << row;
}

TEST_F(Touching, ANodeWithoutAnyMasterHasAMarkerForItsGap) {
  ContactState now = state();
  Patchwise patches(1);
  patches.status[0] = Status::unpaired;
  const Field field = nodal_contact_field(mesh, contact, now, patches);
  for (std::size_t row = 0; row < 3; ++row) {
    EXPECT_EQ(field.at(row, 0), -1);
    EXPECT_EQ(field.at(row, 1), -1);
    EXPECT_EQ(field.presence(row, 1), Field::marker);
    EXPECT_EQ(field.presence(row, 2), Field::there);
  }
}

TEST_F(Touching, AnIncrementIsCutWhereAnOpenPatchGoesIn) {
  // of size 1, from 0.5 apart to 20 inside: at a depth of 1 it has moved by 1.5 of 20.5
  ContactState contact_state = state();
  lift(0.5);
  contact_state.update_geometry(displacement);
  const std::vector<double> before = contact_state.gaps_over_size();
  EXPECT_NEAR(before[0], 0.5, 1e-12);
  contact_state.rest_at(displacement);
  lift(-20);
  contact_state.update_geometry(displacement);
  Patchwise patches(1);
  patches.status[0] = Status::open;
  EXPECT_NEAR(contact_state.part_to_depth(patches, before, 10, 1), 1.5 / 20.5, 1e-12);
  EXPECT_EQ(contact_state.part_to_depth(patches, before, 21, 1), 1);
  lift(0.4);  // a gap of 0.4 that has fallen by 0.1
  contact_state.update_geometry(displacement);
  EXPECT_TRUE(contact_state.closes_within(4, before));
  EXPECT_FALSE(contact_state.closes_within(3, before));
  lift(0.6);
  contact_state.update_geometry(displacement);
  EXPECT_FALSE(contact_state.closes_within(1000, before));
  lift(-20);
  contact_state.update_geometry(displacement);
  EXPECT_EQ(contact_state.part_to_depth(patches, std::vector<double>{-2.0}, 10, 1), 1);  // where it was in already
  patches.status[0] = Status::active;
  EXPECT_EQ(contact_state.part_to_depth(patches, before, 10, 1), 1);
}

}  // namespace
}  // namespace lacon
