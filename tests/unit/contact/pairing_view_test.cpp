// What is drawn and said of a pairing in the plane, where every number is a length.
#include "lacon/operators/contact/pairing_view.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>

#include "lacon/catalog/messages.hpp"

namespace lacon {
namespace {

using testing::HasSubstr;

/// Two slave cells at y = 0.1, x in [0, 1] and [1, 3], each a patch; masters at y = 0, x in [0.3, 1.5] and [-0.5, 0.3], and one
/// below these that shows its back.
struct View : testing::Test {
  Mesh mesh;
  Model model;
  Contact contact;
  Registry registry;
  Field state{.name = "CONT_ELEM", .quantity = "CLAC_R", .location = Location::cells, .components = {"CONT", "PRES"}};

  View() {
    mesh.dimension = 2;
    for (const double x : {0.0, 1.0, 0.5, 3.0, 2.0}) mesh.coordinates.insert(mesh.coordinates.end(), {x, 0.1, 0.0});
    for (const double x : {1.5, 0.3, -0.5}) mesh.coordinates.insert(mesh.coordinates.end(), {x, 0.0, 0.0});
    for (const double x : {0.2, 0.6}) mesh.coordinates.insert(mesh.coordinates.end(), {x, -1.0, 0.0});
    mesh.add_cell(CellType::SEG3, std::vector<std::int32_t>{0, 1, 2});
    mesh.add_cell(CellType::SEG3, std::vector<std::int32_t>{1, 3, 4});
    mesh.add_cell(CellType::SEG2, std::vector<std::int32_t>{5, 6});
    mesh.add_cell(CellType::SEG2, std::vector<std::int32_t>{6, 7});
    mesh.add_cell(CellType::SEG2, std::vector<std::int32_t>{8, 9});
    Patches& patches = mesh.patches.emplace();
    patches.kind = {14, 14};
    for (const std::int32_t cell : {0, 1}) patches.cells.push_back(std::vector<std::int32_t>{cell});
    for (const std::int32_t node : {2, 4}) patches.carriers.push_back(std::vector<std::int32_t>{node});
    model.dimension = 2;
    model.elements = {"D_PLAN/SEG3", "D_PLAN/SEG2"};
    model.element = {0, 0, 1, 1, 1};
    contact.zones.push_back({.slave_group = "SLAVE",
                             .master_group = "MASTER",
                             .slave = {0, 1},
                             .master = {2, 3, 4},
                             .patches = {0, 1},
                             .jacobian = "INITIAL",
                             .search = "RAPIDE",
                             .initial_status = "INTERPENETRE"});
    for (const std::int32_t cell : {0, 1}) contact.slaves.push_back({cell, cell, 0, "LACS32D"});
    state.support = {0, 1};
    state.values = {2, -7, 0, -3};
  }

  PairingView view() { return view_pairing(mesh, model, contact, registry, {.cont_elem = state}); }
};

const PairingLayer& layer(const PairingView& view, std::string_view name) {
  return *std::ranges::find(view.layers, name, &PairingLayer::name);
}

/// The values of a field of one component by its cells.
std::vector<double> values(const PairingLayer& layer, std::string_view name) {
  return std::ranges::find(layer.fields, name, &Field::name)->values;
}

TEST_F(View, ASlaveWithoutLengthIsNamedWithItsSkin) {
  for (const std::size_t node : {3, 4}) mesh.coordinates[3 * node] = 1.0;
  try {
    view();
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.message().id, "EVOLUTION_3");
    EXPECT_THAT(error.message().text, HasSubstr("M2 of SLAVE"));
  }
}

TEST_F(View, PairsAreTheSegmentsThatMastersCutFromTheirSlave) {
  const PairingView all = view();
  const PairingLayer& pairs = layer(all, "PAIRS");
  struct Pair {
    double slave, master, measure, fraction, from, to;
  };
  const std::vector<Pair> expected = {{1, 3, 0.7, 0.7, 0.3, 1.0}, {1, 4, 0.3, 0.3, 0.0, 0.3}, {2, 3, 0.5, 0.25, 1.0, 1.5}};
  ASSERT_EQ(pairs.mesh.n_cells(), expected.size());
  const auto masters = values(pairs, "MASTER"), slaves = values(pairs, "SLAVE"), fractions = values(pairs, "FRACTION");
  for (std::size_t c = 0; c < expected.size(); ++c) {
    const auto pair = std::ranges::find_if(
        expected, [&](const Pair& known) { return known.slave == slaves[c] && known.master == masters[c]; });
    ASSERT_NE(pair, expected.end()) << slaves[c] << " on " << masters[c];
    EXPECT_EQ(values(pairs, "ZONE")[c], 1);
    EXPECT_EQ(values(pairs, "PATCH")[c], pair->slave);
    EXPECT_NEAR(values(pairs, "GAP")[c], 0.1, 1e-14);
    EXPECT_NEAR(values(pairs, "MEASURE")[c], pair->measure, 1e-14);
    EXPECT_NEAR(fractions[c], pair->fraction, 1e-14);
    const auto nodes = pairs.mesh.cells[c];
    ASSERT_EQ(nodes.size(), 3U);
    std::array<double, 3> x{};
    for (std::size_t i = 0; i < 3; ++i) {
      x[i] = pairs.mesh.point(static_cast<std::size_t>(nodes[i]))[0];
      EXPECT_NEAR(pairs.mesh.point(static_cast<std::size_t>(nodes[i]))[1], 0.1, 1e-14);
    }
    EXPECT_NEAR(std::min(x[0], x[1]), pair->from, 1e-14);
    EXPECT_NEAR(std::max(x[0], x[1]), pair->to, 1e-14);
    EXPECT_NEAR(x[2], (pair->from + pair->to) / 2, 1e-14);
  }
}

TEST_F(View, SkinsHaveWhatTheirCellsMeetAndCarry) {
  const PairingView all = view();
  const PairingLayer& skins = layer(all, "SKINS");
  EXPECT_EQ(values(skins, "CELL"), (std::vector<double>{1, 2, 3, 4, 5}));
  EXPECT_EQ(values(skins, "COUPLES"), (std::vector<double>{2, 1, 2, 1, 0}));
  EXPECT_EQ(values(skins, "REJECTED"), (std::vector<double>{1, 0, 0, 0, 1}));
  EXPECT_EQ(values(skins, "PATCH"), (std::vector<double>{1, 2}));
  EXPECT_EQ(values(skins, "STATUS"), (std::vector<double>{2, 0}));
  EXPECT_EQ(values(skins, "PRESSURE"), (std::vector<double>{-7, -3}));
  EXPECT_NEAR(values(skins, "COVERAGE")[0], 1, 1e-14);
  EXPECT_NEAR(values(skins, "COVERAGE")[1], 0.25, 1e-14);
}

TEST_F(View, PointsWeighWhatIsCoveredAndShowTheWayToTheMaster) {
  const PairingView all = view();
  const PairingLayer& points = layer(all, "POINTS");
  const std::vector<double> weight = values(points, "WEIGHT"), way = values(points, "TO_MASTER");
  ASSERT_EQ(way.size(), 2 * weight.size());
  double sum = 0;
  for (std::size_t p = 0; p < weight.size(); ++p) {
    sum += weight[p];
    EXPECT_NEAR(way[2 * p], 0, 1e-14);
    EXPECT_NEAR(way[2 * p + 1], -0.1, 1e-14);
    EXPECT_NEAR(values(points, "GAP")[p], 0.1, 1e-14);
  }
  EXPECT_NEAR(sum, 2 * (1 + 0.25), 1e-14);  // on reference cells of length 2
}

TEST_F(View, ARejectedCoupleIsALineBetweenMiddles) {
  const PairingView all = view();
  const PairingLayer& rejected = layer(all, "REJECTED");
  ASSERT_EQ(rejected.mesh.n_cells(), 1U);
  EXPECT_EQ(values(rejected, "SLAVE"), std::vector<double>{1});
  EXPECT_EQ(values(rejected, "MASTER"), std::vector<double>{5});
  EXPECT_EQ(values(rejected, "REASON"), std::vector<double>{static_cast<double>(Rejection::facing_away)});
  const auto from = rejected.mesh.point(0), to = rejected.mesh.point(1);
  EXPECT_NEAR(from[0], 0.5, 1e-14);
  EXPECT_NEAR(from[1], 0.1, 1e-14);
  EXPECT_NEAR(to[0], 0.4, 1e-14);
  EXPECT_NEAR(to[1], -1, 1e-14);
}

TEST_F(View, TheReportNamesWhatIsNotWhollyCoveredWithItsCouples) {
  const std::vector<std::string> report = view().report;
  ASSERT_EQ(report.size(), 3U);
  EXPECT_THAT(report[0], HasSubstr("zone 1, SLAVE on MASTER: 2 slave cells in 2 patches, 3 master cells, 3 contact cells; "
                                   "covered 1.5 of 3 (50 %)"));
  EXPECT_THAT(report[1], HasSubstr("1 facing away"));
  EXPECT_THAT(report[2], HasSubstr("patch 2, covered to 25 %: M2 on M3: 25 %"));
}

}  // namespace
}  // namespace lacon
