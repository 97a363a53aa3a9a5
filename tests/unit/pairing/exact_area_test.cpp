// Areas of clipped polygons against CGAL, which computes with the same numbers and without rounding.
#include <CGAL/Boolean_set_operations_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_2.h>
#include <CGAL/convex_hull_2.h>
#include <gtest/gtest.h>

#include <iterator>
#include <limits>

#include "lacon/pairing/target.hpp"
#include "region.hpp"
#include "skins_in_space.hpp"

namespace {

using namespace lacon;
using namespace lacon::test;
using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using ExactPolygon = CGAL::Polygon_2<Kernel>;

ExactPolygon exact(const space::Polygon& polygon) {
  ExactPolygon made;
  for (const Vec2 p : polygon) made.push_back({p.x, p.y});
  return made;
}

double rounded(const Kernel::FT& number) { return CGAL::to_double(CGAL::exact(number)); }  // else to 1e-5 alone

double area(const ExactPolygon& polygon) { return rounded(polygon.area()); }

double common_area(const ExactPolygon& a, const ExactPolygon& b) {
  std::vector<CGAL::Polygon_with_holes_2<Kernel>> parts;
  CGAL::intersection(a, b, std::back_inserter(parts));
  Kernel::FT sum = 0;  // of two simple polygons without holes: neither have the parts
  for (const auto& part : parts) sum += part.outer_boundary().area();
  return rounded(sum);
}

/// The convex hull of points, counter-clockwise, without points on its edges.
space::Polygon hull(const std::vector<Vec2>& points) {
  std::vector<Kernel::Point_2> all, corners;
  for (const Vec2 p : points) all.emplace_back(p.x, p.y);
  CGAL::convex_hull_2(all.begin(), all.end(), std::back_inserter(corners));
  space::Polygon polygon;
  for (const Kernel::Point_2& p : corners) polygon.push_back({CGAL::to_double(p.x()), CGAL::to_double(p.y())});
  return polygon;
}

/// A half-plane is evaluated to 4 roundings of a distance, and moves an edge by as much; a new vertex is rounded once more. At
/// most 16 edges, in a box of diagonal `size`.
double rounding(double size) { return 16 * 5 * std::numeric_limits<double>::epsilon() * size * size; }

/// Two convex polygons within [-4, 4] x [-4, 4], of a kind that makes trouble; empty where a draw gives none.
struct Kind {
  const char* name;
  std::pair<space::Polygon, space::Polygon> (*draw)(std::mt19937&);
};

double uniform(std::mt19937& random) { return std::uniform_real_distribution<double>(-1, 1)(random); }

space::Polygon any_polygon(std::mt19937& random) {
  std::vector<Vec2> points(3 + random() % 6);
  for (Vec2& p : points) p = {uniform(random), uniform(random)};
  return hull(points);
}

space::Polygon on_a_lattice(std::mt19937& random) {
  std::vector<Vec2> points(3 + random() % 6);
  for (Vec2& p : points) p = {static_cast<double>(random() % 4), static_cast<double>(random() % 4)};
  return hull(points);
}

/// The images of the corners, the other way round where the map is a reflection.
template <class Map>
space::Polygon mapped(const space::Polygon& polygon, const Map& map) {
  std::vector<Vec2> points;
  for (const Vec2 p : polygon) points.push_back(map(p));
  return hull(points);
}

double magnitude(std::mt19937& random, int least, int most) {
  return std::pow(10.0, -least - static_cast<int>(random() % static_cast<unsigned>(most - least + 1)));
}

const Kind kinds_of_couples[] = {
    {"any",
     [](std::mt19937& random) {
       return std::pair{any_polygon(random), any_polygon(random)};
     }},
    {"on a lattice: edges and corners in common",
     [](std::mt19937& random) {
       return std::pair{on_a_lattice(random), on_a_lattice(random)};
     }},
    {"the same",
     [](std::mt19937& random) {
       const space::Polygon a = any_polygon(random);
       return std::pair{a, a};
     }},
    {"neighbours with a corner in common",
     [](std::mt19937& random) {
       const space::Polygon a = any_polygon(random);
       return std::pair{a, mapped(a, [v = a[0]](Vec2 p) { return v + (v - p); })};
     }},
    {"neighbours with an edge in common",
     [](std::mt19937& random) {
       const space::Polygon a = any_polygon(random);
       const Vec2 v = a[0], w = a[1];
       return std::pair{a, mapped(a, [v, w](Vec2 p) { return (v + w) - p; })};
     }},
    {"slivers",
     [](std::mt19937& random) {
       const double thickness = magnitude(random, 2, 15);
       return std::pair{mapped(any_polygon(random), [&](Vec2 p) { return Vec2{p.x, thickness * p.y}; }), any_polygon(random)};
     }},
    {"nearly parallel edges",
     [](std::mt19937& random) {
       const space::Polygon a = any_polygon(random);
       const double turn = magnitude(random, 4, 17), shift = magnitude(random, 4, 17);
       return std::pair{a, mapped(a, [&](Vec2 p) { return Vec2{p.x - turn * p.y + shift, p.y + turn * p.x}; })};
     }},
};

TEST(ExactAreas, OfWhatTwoConvexPolygonsHaveInCommonAndOfWhatIsLeft) {
  std::mt19937 random(1);
  for (const Kind& kind : kinds_of_couples)
    for (int trial = 0; trial < 300; ++trial) {
      const auto [p, q] = kind.draw(random);
      if (p.size() < 3 || q.size() < 3) continue;
      const ExactPolygon a = exact(p), b = exact(q);
      const double common = common_area(a, b), tolerance = rounding(8);
      const space::Region ra = region(p), rb = region(q);
      EXPECT_NEAR(0.5 * space::double_area(space::intersection(ra, rb).polygon), common, tolerance)
          << kind.name << " " << trial;
      EXPECT_NEAR(0.5 * space::double_area(space::intersection(rb, ra).polygon), common, tolerance)
          << kind.name << " " << trial;
      std::vector<space::Region> rest;
      space::subtract(ra, rb, 0, rest);
      double left = 0;
      for (const space::Region& part : rest) left += 0.5 * space::double_area(part.polygon);
      EXPECT_NEAR(left, area(a) - common, tolerance) << kind.name << " " << trial;
    }
}

/// A facet in the plane z, its corners given as seen from above.
Skin3 facet_at(double z, const space::Polygon& corners, bool up) {
  Skin3 skin;
  std::vector<std::int32_t> nodes;
  for (const Vec2 p : corners) nodes.push_back(skin.add_node({p.x, p.y, z}));
  if (!up) std::reverse(nodes.begin(), nodes.end());
  skin.surface.add_cell(nodes.size() == 3 ? CellType::TRIA3 : CellType::QUAD4, nodes);
  return skin;
}

/// A triangle, a convex quadrangle or, if `reflex`, one whose third corner turns the other way; counter-clockwise, begun
/// anywhere.
space::Polygon facet_corners(std::mt19937& random, bool reflex) {
  space::Polygon polygon;
  while (polygon.size() != 3 && polygon.size() != 4) polygon = any_polygon(random);
  if (reflex) {
    polygon.resize(3);
    const double s = 0.05 + 0.4 * std::abs(uniform(random)), t = 0.05 + 0.4 * std::abs(uniform(random));
    polygon.insert(polygon.begin() + 2, polygon[0] + s * (polygon[1] - polygon[0]) + t * (polygon[2] - polygon[0]));
  }
  std::rotate(polygon.begin(), polygon.begin() + static_cast<std::ptrdiff_t>(random() % polygon.size()), polygon.end());
  return polygon;
}

TEST(ExactAreas, OfWhatASlaveSeesOfConvexAndNonConvexMasters) {
  std::mt19937 random(2);
  space::SlaveFacet slave;
  std::vector<Vec3> outline;
  std::vector<space::Part> parts;
  space::Region seen;
  space::Polygon scratch;
  for (int trial = 0; trial < 600; ++trial) {
    const space::Polygon p = facet_corners(random, false), q = facet_corners(random, trial % 2 == 0);
    Skin3 below = facet_at(0, p, true), above = facet_at(0.3, q, false);
    const PairingTolerances tolerances;
    slave.set(below.view(), 0, 1, tolerances);
    slave.lay_out(false);
    if (slave.degenerate) continue;
    ASSERT_TRUE(slave.constant);
    const space::Facet master = space::facet(above.view(), 0, tolerances.straight);
    space::cut_in_parts(master, space::nodes_of(above.surface, 0, slave.f.origin), slave, outline, parts);
    double sum = 0;
    for (const space::Part& part : parts) {
      space::see(slave, slave.pieces[0], part, true, seen, scratch);
      sum += 0.5 * space::double_area(seen.polygon);
    }
    EXPECT_NEAR(sum, common_area(exact(p), exact(q)), rounding(3)) << trial;
  }
}

}  // namespace
