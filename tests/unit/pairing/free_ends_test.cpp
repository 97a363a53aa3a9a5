// Where skins end, and who keeps what two free ends cover that have slid over each other.
#include "lacon/pairing/free_ends.hpp"

#include <gtest/gtest.h>

#include <random>

#include "skins.hpp"
#include "skins_in_space.hpp"

namespace lacon {
namespace {

using namespace test;

TEST(FreeEnds, AreWhereASkinEndsOrFolds) {
  Skin skin;  // a flat, a slope of 45 degrees, a wall
  for (const Point p : {Point{0, 0}, Point{1, 0}, Point{2, -1}, Point{2, -3}}) skin.add_node(p);
  for (const std::int32_t i : {0, 1, 2}) skin.add_cell({i, i + 1});
  EXPECT_EQ(free_ends(skin.view()), (std::vector<std::uint8_t>{0b01, 0b00, 0b10}));
  skin.coordinates[9] = 1.8;  // it leans back by more: 60 degrees and a little
  EXPECT_EQ(free_ends(skin.view()), (std::vector<std::uint8_t>{0b01, 0b00, 0b10}));
  skin.coordinates[9] = 0;
  EXPECT_EQ(free_ends(skin.view()), (std::vector<std::uint8_t>{0b01, 0b10, 0b11}));
}

TEST(FreeEnds, AreEdgesInSpace) {
  Skin3 skin;  // two squares beside each other, and a wall below the second one
  for (const Vec3 p : {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{2, 0, 0}, Vec3{0, 1, 0}, Vec3{1, 1, 0}, Vec3{2, 1, 0}, Vec3{2, 0, -1},
                       Vec3{2, 1, -1}})
    skin.add_node(p);
  for (const std::array<std::int32_t, 4> nodes : {std::array{0, 1, 4, 3}, std::array{1, 2, 5, 4}, std::array{2, 6, 7, 5}})
    skin.surface.add_cell(CellType::QUAD4, nodes);
  EXPECT_EQ(free_ends(skin.view()), (std::vector<std::uint8_t>{0b1101, 0b0111, 0b1111}));
}

constexpr double hair = 0.05, wide = 0.4;  // of cells of size 1

/// The weights of all points that see one of the first masters. @param known whether their free ends are
double weight_of_first(const Surface& slave, Surface masters, std::int32_t n_first, bool known = true) {
  const std::vector<std::uint8_t> ends = free_ends(masters);
  if (known) masters.free_ends = ends;
  const ContactCells cells = pair(slave, masters).cells;
  double sum = 0;
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (auto p = cells.offset[c]; p < cells.offset[c + 1]; ++p)
      sum += cells.master[c] < n_first ? cells.weight[static_cast<std::size_t>(p)] : 0;
  return sum;
}

/// Two masters of size 1, the second one above the first by `step`, that share a strip in the middle of a slave cell of size 1.
/// @return how much of the slave cell sees the first
double first_sees(double width, double step, bool known = true) {
  Skin slave, master;
  add_chain(
      slave,
      [](double t) {
        return Point{t, 0.3};
      },
      {0, 1}, Kind::linear);
  add_chain(
      master,
      [](double t) {
        return Point{t, 0.0};
      },
      {0.5 + width / 2, -0.5 + width / 2}, Kind::linear);
  add_chain(
      master,
      [&](double t) {
        return Point{t, step};
      },
      {1.5 - width / 2, 0.5 - width / 2}, Kind::linear);
  return 0.5 * weight_of_first(slave.view(), master.view(), 1, known);
}

TEST(FreeEnds, KeepWhatTheyShareHoweverTheyAreRaised) {
  const double kept = 0.5 + hair / 2, lost = 0.5 - hair / 2;
  for (const double step : {-0.09, -1e-3, 0.0, 1e-3, 0.09}) EXPECT_NEAR(first_sees(hair, step), kept, 1e-14) << step;
  EXPECT_NEAR(first_sees(hair, 0.11), lost, 1e-14);  // that is a step, and the upper one is in front
  EXPECT_NEAR(first_sees(hair, -0.11), kept, 1e-14);
  EXPECT_NEAR(first_sees(hair, 1e-3, false), lost, 1e-14);
  EXPECT_NEAR(first_sees(wide, 1e-3), 0.5 - wide / 2, 1e-14);  // a sheet that lies on a block
  EXPECT_NEAR(first_sees(wide, -1e-3), 0.5 + wide / 2, 1e-14);
}

// A sheet of two cells on a block of two, under slave cells that see a narrow part of it: its ends look as those of the block
// do.
TEST(FreeEnds, OfASheetHideTheBlockBelow) {
  for (const double at : {0.02, 0.5, 0.98, 1.02, 1.98}) {
    Skin slave, master;
    add_chain(
        slave,
        [](double t) {
          return Point{t, 0.1};
        },
        {at - 0.06, at + 0.06}, Kind::linear);
    add_chain(
        master,
        [](double t) {
          return Point{t, 0.0};
        },
        {2.02, 1, -0.02}, Kind::linear);
    add_chain(
        master,
        [](double t) {
          return Point{t, 0.005};
        },
        {2, 1.1, 0}, Kind::linear);
    const double of_block = 0.06 * weight_of_first(slave.view(), master.view(), 2);
    const double beside = std::max(0.0, 0.06 - at) + std::max(0.0, at + 0.06 - 2);  // of the sheet
    EXPECT_NEAR(of_block, std::min(beside, 0.02), 1e-12) << at;
  }
}

TEST(FreeEnds, KeepWhatTheyShareInSpace) {
  std::mt19937 random(3);
  const auto first_sees = [&](double width, double step) {
    Skin3 slave = mesh(
        {1, 1, CellType::QUAD4, false},
        [](double x, double y) {
          return Vec3{x, y, 0.3};
        },
        random);
    Skin3 master = mesh(
        {1, 2, CellType::QUAD8, true, 0, -0.5 + width / 2, 0.5 + width / 2},
        [](double x, double y) {
          return Vec3{x, y, 0};
        },
        random);
    const Skin3 other = mesh(
        {1, 1, CellType::QUAD8, true, 0, 0.5 - width / 2, 1.5 - width / 2},
        [&](double x, double y) {
          return Vec3{x, y, step};
        },
        random);
    const auto shift = static_cast<std::int32_t>(master.n_nodes());
    master.coordinates.insert(master.coordinates.end(), other.coordinates.begin(), other.coordinates.end());
    std::vector<std::int32_t> nodes(other.surface.nodes[0].begin(), other.surface.nodes[0].end());
    for (std::int32_t& node : nodes) node += shift;
    master.surface.add_cell(CellType::QUAD8, nodes);
    return 0.25 * weight_of_first(slave.view(), master.view(), 2);
  };
  for (const double step : {-0.09, -1e-3, 0.0, 1e-3, 0.09}) EXPECT_NEAR(first_sees(hair, step), 0.5 + hair / 2, 1e-13) << step;
  EXPECT_NEAR(first_sees(hair, 0.2), 0.5 - hair / 2, 1e-13);
  EXPECT_NEAR(first_sees(wide, 1e-3), 0.5 - wide / 2, 1e-13);
}

TEST(Pairing, LeavesOutCouplesThatItIsTold) {
  Skin slave, master;
  add_chain(
      slave,
      [](double t) {
        return Point{t, 0.1};
      },
      {0, 1, 2}, Kind::linear);
  add_chain(
      master,
      [](double t) {
        return Point{t, 0.0};
      },
      {2.5, -0.5}, Kind::linear);
  const std::vector<Couple> out{{1, 0}};
  const Pairing found = pair(slave.view(), master.view(), {.left_out = out});
  EXPECT_EQ(found.cells.slave, std::vector<std::int32_t>{0});
  EXPECT_EQ(found.rejected, (std::vector<RejectedCouple>{{1, 0, Rejection::far_behind}}));
}

/// Side by side at the height 0.1, looking down.
Skin3 two_squares(std::mt19937& random) {
  return mesh(
      {2, 1, CellType::QUAD4, false},
      [](double x, double y) {
        return Vec3{x, y, 0.1};
      },
      random);
}

TEST(PairingInSpace, LeavesOutCouplesThatItIsTold) {
  std::mt19937 random(4);
  Skin3 slave = two_squares(random);
  Skin3 master = mesh(
      {1, 1, CellType::QUAD4, true, 0, -1, 2, -1, 2},
      [](double x, double y) {
        return Vec3{x, y, 0};
      },
      random);
  const std::vector<Couple> out{{1, 0}};
  const Pairing found = pair(slave.view(), master.view(), {.left_out = out});
  EXPECT_EQ(found.cells.slave, std::vector<std::int32_t>{0});
  EXPECT_EQ(found.rejected, (std::vector<RejectedCouple>{{1, 0, Rejection::far_behind}}));
}

TEST(Faces, EndWhereASkinEndsOrTurnsAwayByMoreThanSixtyDegrees) {
  for (const double turn : {-61.0, -59.0, 59.0, 61.0}) {
    Skin chain;
    const double angle = turn * std::numbers::pi / 180;
    add_chain(
        chain,
        [&](double t) {
          return t < 2 ? Point{t, 0} : Point{2 + (t - 2) * std::cos(angle), (t - 2) * std::sin(angle)};
        },
        {0, 1, 2, 3, 4}, Kind::linear);
    add_chain(
        chain,
        [](double t) {
          return Point{t, 5.0};
        },
        {0, 1}, Kind::linear);
    const bool folds = turn > 60;  // cells look down: a concave edge ends no face
    EXPECT_EQ(faces(chain.view()), (std::vector<std::int32_t>{0, 0, folds ? 2 : 0, folds ? 2 : 0, 4})) << turn;

    std::mt19937 random(4);
    Skin3 skin = mesh(
        {4, 2, CellType::QUAD8, false},
        [&](double x, double y) {
          return x < 0.5 ? Vec3{x, y, 0} : Vec3{0.5 + (x - 0.5) * std::cos(angle), y, (x - 0.5) * std::sin(angle)};
        },
        random);
    const std::vector<std::int32_t> found = faces(skin.view());
    EXPECT_EQ(std::set(found.begin(), found.end()).size(), folds ? 2U : 1U) << turn;
    EXPECT_EQ(std::ranges::count(found, 0), folds ? 4 : 8) << turn;
  }
}

TEST(Faces, GoOnOverCurvedCellsWhoseChordsTurnFar) {
  for (const Kind kind : {Kind::linear, Kind::quadratic}) {
    Skin arc;  // by 70 degrees a cell, around what lies above it
    add_chain(
        arc,
        [](double t) {
          const double angle = 70 * t * std::numbers::pi / 180;
          return Point{std::sin(angle), -std::cos(angle)};
        },
        {0, 1, 2}, kind);
    EXPECT_EQ(faces(arc.view()), (std::vector<std::int32_t>{0, kind == Kind::linear ? 1 : 0}));
  }
}

/// Masters below slaves, which lean by `leans` degrees now and by `leant` at rest.
TEST(Pairing, LeavesOutWhatWasAWallAtRest) {
  const auto turned = [](double degrees) {
    return [=](double t) {
      const double angle = degrees * std::numbers::pi / 180;
      return Point{0.5 + t * std::cos(angle), -2 + t * std::sin(angle)};
    };
  };
  Ragged<std::int32_t> own, other;  // faces in front
  own.push_back(std::array{0});
  other.push_back(std::array{1});
  const std::array faces{0};
  for (const double leans : {50.0, 70.0})
    for (const double leant : {59.0, 61.0}) {
      Skin slave, master, rest;
      add_chain(
          slave,
          [](double t) {
            return Point{t, 0.1};
          },
          {0, 1}, Kind::linear);
      add_chain(master, turned(leans), {1, 0}, Kind::linear);
      add_chain(rest, turned(leant), {1, 0}, Kind::linear);
      Surface skin = master.view();
      skin.rest = rest.view().coordinates;
      const bool wall = leant > 60;
      EXPECT_EQ(pair(slave.view(), skin, {.in_front = &own, .faces = faces}).cells.size(), 1U);
      const Pairing found = pair(slave.view(), skin, {.in_front = &other, .faces = faces});
      EXPECT_EQ(found.cells.size(), wall ? 0U : 1U) << leans << ' ' << leant;
      EXPECT_EQ(found.count(Rejection::wall), wall ? 1 : 0);
      EXPECT_EQ(was_wall(slave.view(), 0, skin, 0), wall);
    }
}

TEST(PairingInSpace, LeavesOutWhatWasAWallAtRest) {
  const auto leaning = [](double degrees) {
    return [=](double x, double y) {
      const double angle = degrees * std::numbers::pi / 180;
      return Vec3{0.5 + x * std::cos(angle), y, -2 + x * std::sin(angle)};
    };
  };
  std::mt19937 random(4);
  Skin3 slave = two_squares(random);
  for (const CellType type : {CellType::QUAD4, CellType::TRIA6})
    for (const double leant : {59.0, 61.0}) {
      Skin3 master = mesh({1, 1, type, true, 0, -1, 2, -1, 2}, leaning(70), random),
            rest = mesh({1, 1, type, true, 0, -1, 2, -1, 2}, leaning(leant), random);
      Surface skin = master.view();
      skin.rest = rest.view().coordinates;
      const Pairing before = pair(slave.view(), skin);
      Ragged<std::int32_t> second;
      second.push_back(std::vector<std::int32_t>());
      second.push_back(std::array{1});
      const std::vector<std::int32_t> faces(master.view().size(), 0);
      const Pairing found = pair(slave.view(), skin, {.in_front = &second, .faces = faces});
      const auto of_second = [](const Pairing& one) { return std::ranges::count(one.cells.slave, 1); };
      ASSERT_GT(of_second(before), 0);
      EXPECT_EQ(of_second(found), leant > 60 ? 0 : of_second(before));
      EXPECT_EQ(found.cells.size() - of_second(found), before.cells.size() - of_second(before));
      EXPECT_EQ(found.count(Rejection::wall), leant > 60 ? of_second(before) : 0);
    }
}

}  // namespace
}  // namespace lacon
