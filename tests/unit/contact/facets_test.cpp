// The curves that facets stand for: their sagittas by formula, and where there are none.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>

#include "lacon/operators/contact/facets.hpp"

namespace lacon {
namespace {

constexpr double pi = std::numbers::pi;

/// A skin that owns its nodes.
struct Nodes {
  std::vector<double> coordinates;
  Surface skin;

  explicit Nodes(int dimension) { skin.dimension = dimension; }
  std::int32_t add(Vec3 place) {
    coordinates.insert(coordinates.end(), {place.x, place.y, place.z});
    skin.coordinates = coordinates;
    return static_cast<std::int32_t>(coordinates.size() / 3) - 1;
  }
  Vec3 at(std::int32_t node) const { return vector_at(&coordinates[3 * static_cast<std::size_t>(node)]); }
  Vec3 middle(std::size_t cell) const {
    return middle_of(skin.nodes[cell].first(static_cast<std::size_t>(catalog::cell(skin.types[cell]).n_vertices)), coordinates);
  }
  std::vector<FacetArc> arcs() const {
    std::vector<std::int32_t> each(skin.size());
    std::iota(each.begin(), each.end(), 0);
    return arcs_of_cells(skin, each);
  }
};

/// A closed line through the points of a function of 0 <= t < 1.
Nodes ring(int n, CellType type, const std::function<Vec3(double)>& point) {
  Nodes nodes(2);
  for (int i = 0; i < 2 * n; ++i) nodes.add(point(i / (2.0 * n)));
  for (std::int32_t i = 0; i < n; ++i) {
    std::vector<std::int32_t> cell = {2 * i, (2 * i + 2) % (2 * n), 2 * i + 1};
    if (type == CellType::SEG2) cell.pop_back();
    nodes.skin.add_cell(type, cell);
  }
  return nodes;
}

TEST(Facets, LackTheSagittaOfTheArcsThatTheyStandFor) {
  // chords of a circle lie below it by r (1 - cos(t)) in the middle, t half the angle of a chord
  constexpr int n = 40;
  constexpr double radius = 3;
  const double sagitta = radius * (1 - std::cos(pi / n));
  const auto circle = [](double t) { return Vec3{radius * std::cos(2 * pi * t), radius * std::sin(2 * pi * t), 0}; };
  const Nodes chords = ring(n, CellType::SEG2, circle), arcs = ring(n, CellType::SEG3, circle);
  const std::vector<FacetArc> of_chords = chords.arcs(), of_arcs = arcs.arcs();
  for (std::size_t cell = 0; cell < n; ++cell) {
    EXPECT_TRUE(of_chords[cell].is_of_curve());
    EXPECT_NEAR(of_chords[cell].missing(chords.middle(cell)), sagitta, 0.01 * sagitta);
    EXPECT_NEAR(of_chords[cell].missing(chords.at(chords.skin.nodes[cell][0])), 0, 1e-14);
    EXPECT_NEAR(of_chords[cell].curvature(), 1 / radius, 0.01 / radius);
    EXPECT_NEAR(of_arcs[cell].missing(arcs.at(arcs.skin.nodes[cell][2])), 0, 0.01 * sagitta);
  }
}

TEST(Facets, OfPolygonsStandForNoCurve) {
  // hexagon: each side has n / 6 cells, of which two meet a corner
  constexpr int n = 24;
  const Nodes hexagon = ring(n, CellType::SEG2, [](double t) {
    const double side = std::floor(6 * t + 1e-9), along = 6 * t - side;
    const Vec3 a = {std::cos(pi / 3 * side), std::sin(pi / 3 * side), 0},
               b = {std::cos(pi / 3 * (side + 1)), std::sin(pi / 3 * (side + 1)), 0};
    return (1 - along) * a + along * b;
  });
  const std::vector<FacetArc> arcs = hexagon.arcs();
  for (std::size_t cell = 0; cell < n; ++cell)
    EXPECT_EQ(arcs[cell].is_of_curve() && arcs[cell].curvature() > 1e-9, false) << cell;
  // corners that turn by less than those of ten edges a turn do: 24 sides of two cells
  const Nodes blunt = ring(2 * n, CellType::SEG2, [](double t) {
    const double side = std::floor(n * t + 1e-9), along = n * t - side, turn = 2 * pi / n;
    const Vec3 a = {std::cos(turn * side), std::sin(turn * side), 0},
               b = {std::cos(turn * (side + 1)), std::sin(turn * (side + 1)), 0};
    return (1 - along) * a + along * b;
  });
  for (const FacetArc& arc : blunt.arcs()) EXPECT_FALSE(arc.is_of_curve());
}

// Around the edge of a box nodal normals look between its sides.
TEST(Facets, BesideEdgesOfBodiesStandForNoCurve) {
  constexpr int n = 3;  // cells along each of two sides that meet
  Nodes box(3);
  for (int i = 0; i <= 2 * n; ++i)
    for (int j = 0; j <= n; ++j) box.add({std::min<double>(i, n), 1.0 * j, std::min<double>(2 * n - i, n)});
  for (int i = 0; i < 2 * n; ++i)
    for (int j = 0; j < n; ++j) {
      const std::int32_t a = i * (n + 1) + j;
      box.skin.add_cell(CellType::QUAD4, std::vector<std::int32_t>{a, a + n + 1, a + n + 2, a + 1});
    }
  const std::vector<FacetArc> arcs = box.arcs();
  for (int i = 0; i < 2 * n; ++i)
    for (int j = 0; j < n; ++j) {
      const auto cell = static_cast<std::size_t>(i * n + j);
      EXPECT_EQ(arcs[cell].is_of_curve(), i != n - 1 && i != n) << i;
      if (arcs[cell].is_of_curve()) {
        EXPECT_NEAR(arcs[cell].missing(box.middle(cell)), 0, 1e-14);
      }
    }
}

// Facets of a sphere, small ones: below it by half of the square of what the corners are away from the middle, over the radius.
TEST(Facets, LackTheSagittaOfSpheres) {
  constexpr double radius = 2, t = 0.05;  // half an angle between two nodes
  constexpr int n = 6, width = 2 * n + 1;
  for (const bool triangles : {false, true}) {
    Nodes sphere(3);
    for (int j = -n; j <= n; ++j)
      for (int i = -n; i <= n; ++i) {
        const double x = std::sin(t * i), y = std::sin(t * j);
        sphere.add(radius * Vec3{x, y, std::sqrt(1 - x * x - y * y)});
      }
    for (int j = -2; j < 2; ++j)
      for (int i = -2; i < 2; ++i) {
        const std::int32_t a = (j + n) * width + i + n, b = a + 1, c = b + width, d = c - 1;
        if (triangles) {
          sphere.skin.add_cell(CellType::TRIA3, std::vector<std::int32_t>{a, b, c});
          sphere.skin.add_cell(CellType::TRIA3, std::vector<std::int32_t>{a, c, d});
        } else {
          sphere.skin.add_cell(CellType::QUAD4, std::vector<std::int32_t>{a, b, c, d});
        }
      }
    const std::vector<FacetArc> arcs = sphere.arcs();
    int inside = 0;  // of the skin, where normals are those of the sphere
    for (std::size_t cell = 0; cell < arcs.size(); ++cell) {
      const auto nodes = sphere.skin.nodes[cell];
      if (!std::ranges::all_of(
              nodes, [&](std::int32_t node) { return std::abs(node % width - n) < 2 && std::abs(node / width - n) < 2; }))
        continue;
      ++inside;
      const Vec3 middle = sphere.middle(cell);
      EXPECT_TRUE(arcs[cell].is_of_curve());
      EXPECT_NEAR(arcs[cell].missing(middle), radius - norm(middle), 0.02 * t * t) << cell;
      EXPECT_NEAR(arcs[cell].curvature(), 1 / radius, 0.02 / radius);
    }
    EXPECT_EQ(inside, triangles ? 8 : 4);
  }
}

// Where a skin ends its last normal is that of the last facet; that one is bent as the facet beside it.
TEST(Facets, AtTheEndOfASkinAreOfTheCurveToo) {
  constexpr int n = 10;
  constexpr double radius = 3, turn = pi / 40;
  Nodes arc(2);
  for (int i = 0; i <= n; ++i) arc.add({radius * std::cos(turn * i), radius * std::sin(turn * i), 0});
  arc.add({radius * std::cos(turn * n) - 1, radius * std::sin(turn * n), 0});  // another face, beyond a corner
  for (std::int32_t i = 0; i <= n; ++i) arc.skin.add_cell(CellType::SEG2, std::vector<std::int32_t>{i, i + 1});
  const std::vector<FacetArc> arcs = arc.arcs();
  for (std::size_t cell = 0; cell + 1 < n; ++cell) {
    EXPECT_TRUE(arcs[cell].is_of_curve()) << cell;
    EXPECT_NEAR(arcs[cell].missing(arc.middle(cell)), radius * (1 - std::cos(turn / 2)), 1e-5 * radius) << cell;
  }
  EXPECT_FALSE(arcs[n - 1].is_of_curve());
  EXPECT_FALSE(arcs[n].is_of_curve());
}

// A patch of triangles around a middle node stands for the curve that its quadrangle did.
TEST(Facets, OfSeveralCellsStandForOneCurve) {
  constexpr int n = 20;
  constexpr double radius = 5, turn = 2 * pi / 60;
  Nodes cylinder(3);
  for (int i = 0; i <= n; ++i)
    for (const double z : {0.0, 1.0}) cylinder.add({radius * std::cos(turn * i), radius * std::sin(turn * i), z});
  std::vector<std::int32_t> patch_of;
  for (std::int32_t i = 0; i < n; ++i) {
    const std::int32_t corners[] = {2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1};
    const std::int32_t inner = cylinder.add(middle_of(corners, cylinder.coordinates));
    for (int k = 0; k < 4; ++k) {
      cylinder.skin.add_cell(CellType::TRIA3, std::vector<std::int32_t>{corners[k], corners[(k + 1) % 4], inner});
      patch_of.push_back(i);
    }
  }
  const std::vector<FacetArc> arcs = arcs_of_cells(cylinder.skin, patch_of);
  const double sagitta = radius * (1 - std::cos(turn / 2));
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < 4; ++k) {
      const auto cell = static_cast<std::size_t>(4 * i + k);
      EXPECT_TRUE(arcs[cell].is_of_curve());
      EXPECT_NEAR(arcs[cell].missing(cylinder.at(cylinder.skin.nodes[cell][2])), sagitta, 0.02 * sagitta);  // cos^2 of a turn
    }
  const std::vector<std::uint8_t> inner = inner_nodes(cylinder.skin, patch_of);
  EXPECT_EQ(std::accumulate(inner.begin(), inner.end(), 0), n);
}

}  // namespace
}  // namespace lacon
