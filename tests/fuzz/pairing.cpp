// Pairing against rays (in the plane), against common areas (flat skins in space), and against the search of every couple.
#include "lacon/pairing/pairing.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "fuzz.hpp"
#include "polygons.hpp"

namespace lacon::fuzz {
namespace {

/// A skin that owns its coordinates.
struct Skin {
  std::vector<double> coordinates;
  Surface surface;

  std::int32_t add_node(double x, double y, double z) {
    coordinates.insert(coordinates.end(), {x, y, z});
    return static_cast<std::int32_t>(coordinates.size() / 3) - 1;
  }
  void add_cell(CellType type, const std::vector<std::int32_t>& nodes) { surface.add_cell(type, nodes); }
  Vec2 node(std::size_t cell, std::size_t local) const {
    const auto at = 3 * static_cast<std::size_t>(surface.nodes[cell][local]);
    return {coordinates[at], coordinates[at + 1]};
  }
  const Surface& view(int dimension) {
    surface.dimension = dimension;
    surface.coordinates = coordinates;
    return surface;
  }
};

void expect_same_as_every_couple(const Surface& slave, const Surface& master, const Pairing& found) {
  PairingOptions options;
  options.brute_force = true;
  const Pairing all = pair(slave, master, options);
  expect(all.cells == found.cells, "the search finds what the try of every couple finds");
  expect(all.rejected == found.rejected, "the search rejects what the try of every couple rejects");
}

// ---------------------------------------------------------------------------------------------- in the plane

/// Straight cells along x, from left to right or back, with nodes on a lattice.
Skin chain(Choices& choices, int lowest, bool back) {
  std::vector<Vec2> points{{static_cast<double>(choices.between(-8, 8)), static_cast<double>(lowest + choices.below(8))}};
  for (int n = choices.between(1, 6); n > 0; --n) {
    const double step = choices.between(1, 6), y = lowest + choices.below(8);
    points.push_back({points.back().x + step, y});
  }
  if (back) std::reverse(points.begin(), points.end());
  Skin skin;
  std::int32_t before = -1;
  for (const Vec2 p : points) {
    const std::int32_t now = skin.add_node(p.x, p.y, 0);
    if (before >= 0) skin.add_cell(CellType::SEG2, {before, now});
    before = now;
  }
  return skin;
}

double length(Vec2 v) { return std::hypot(v.x, v.y); }

/// Where the normal of a slave cell at x meets a master cell that faces it.
struct Hit {
  bool found = false, near_end = false;
  double gap = 0;
};
Hit cast(const Skin& slave, std::size_t e, Vec2 x, const Skin& master, std::size_t m) {
  const Vec2 t = slave.node(e, 1) - slave.node(e, 0), a = master.node(m, 0), b = master.node(m, 1);
  const double size = length(t) * length(b - a), f_a = dot(a - x, t), f_b = dot(b - x, t);
  Hit hit;
  hit.near_end = std::abs(f_a) < 1e-9 * size || std::abs(f_b) < 1e-9 * size;
  hit.found = f_a > 0 && f_b < 0;
  if (!hit.found) return hit;
  const Vec2 y = a + (f_a / (f_a - f_b)) * (b - a);
  hit.gap = cross(y - x, t) / length(t);  // along n = (t_y, -t_x)
  return hit;
}

/// Of the angle between the normal of a slave cell and the opposite of a master's.
double cosine(const Skin& slave, std::size_t e, const Skin& master, std::size_t m) {
  const Vec2 t = slave.node(e, 1) - slave.node(e, 0), along = master.node(m, 1) - master.node(m, 0);
  return -dot(t, along) / (length(t) * length(along));
}

void pairing_in_plane(Choices& choices) {
  Skin slave = chain(choices, -2, false), master = chain(choices, -8, true);
  const Pairing found = pair(slave.view(2), master.view(2));
  const ContactCells& cells = found.cells;
  std::map<std::size_t, std::vector<std::size_t>> of_slave;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const auto e = static_cast<std::size_t>(cells.slave[c]), m = static_cast<std::size_t>(cells.master[c]);
    of_slave[e].push_back(c);
    const double from = cells.vertex[2 * c], to = cells.vertex[2 * c + 1];
    expect(from >= -1 && to <= 1 && from < to, "a contact cell lies in its slave");
    double sum = 0;
    for (auto p = static_cast<std::size_t>(cells.offset[c]); p < static_cast<std::size_t>(cells.offset[c + 1]); ++p) {
      sum += cells.weight[p];
      const double s = 0.5 * (1 + cells.slave_point[p]), r = 0.5 * (1 + cells.master_point[p]);
      const Vec2 t = slave.node(e, 1) - slave.node(e, 0), x = slave.node(e, 0) + s * t;
      const Vec2 y = master.node(m, 0) + r * (master.node(m, 1) - master.node(m, 0));
      expect(std::abs(dot(y - x, t)) <= 1e-9 * dot(t, t), "an image lies on the normal of its point");
    }
    const double share = share_of_couple(cosine(slave, e, master, m), steep_cosine({})).value;
    expect(std::abs(sum - share * (to - from)) <= 1e-12, "weights sum up to the contact cell");
  }
  for (std::size_t e = 0; e < slave.surface.size(); ++e)
    for (const double xi : {-0.93, -0.51, -0.13, 0.29, 0.61, 0.97}) {
      const Vec2 t = slave.node(e, 1) - slave.node(e, 0), x = slave.node(e, 0) + 0.5 * (1 + xi) * t;
      bool hit = false, doubtful = false;
      for (std::size_t m = 0; m < master.surface.size(); ++m) {
        const Hit one = cast(slave, e, x, master, m);
        const bool steep = cosine(slave, e, master, m) < 1e-6;  // its share is round-off
        hit = hit || (one.found && !steep);
        doubtful = doubtful || one.near_end || (one.found && steep);
      }
      int covering = 0;
      for (const std::size_t c : of_slave[e])
        if (cells.vertex[2 * c] <= xi && xi <= cells.vertex[2 * c + 1]) {
          ++covering;
          const Hit one = cast(slave, e, x, master, static_cast<std::size_t>(cells.master[c]));
          expect(one.found || doubtful, "the normal of a slave meets the master that it was given");
        }
      if (!doubtful) expect(covering == (hit ? 1 : 0), "a point of a slave is paired once where its normal meets a master");
    }
  expect_same_as_every_couple(slave.view(2), master.view(2), found);
}

// ---------------------------------------------------------------------------------------------- in space

/// Triangles over the cells of a lattice that was pushed about: flat, all of them at one height or each node at its own.
Skin sheet(Choices& choices, bool up, double height, bool flat) {
  const int nx = choices.between(1, 3), ny = choices.between(1, 3);
  const double width = choices.between(6, 12), x0 = choices.below(6), y0 = choices.below(6);
  Skin skin;
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i) {
      const double x = x0 + i * width + choices.between(-1, 1), y = y0 + j * width + choices.between(-1, 1);
      skin.add_node(x, y, flat ? height : height + 0.5 * choices.below(4));
    }
  const auto add = [&](std::int32_t a, std::int32_t b, std::int32_t c) {
    skin.add_cell(CellType::TRIA3, up ? std::vector<std::int32_t>{a, b, c} : std::vector<std::int32_t>{a, c, b});
  };
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const std::int32_t a = j * (nx + 1) + i, b = a + 1, c = b + nx + 1, d = c - 1;
      if (choices.below(2) == 0)
        add(a, b, c), add(a, c, d);
      else
        add(a, b, d), add(b, c, d);
    }
  return skin;
}

/// A cell seen from above, counter-clockwise.
space::Polygon seen(const Skin& skin, std::size_t cell) {
  space::Polygon polygon{skin.node(cell, 0), skin.node(cell, 1), skin.node(cell, 2)};
  if (area(polygon) < 0) std::reverse(polygon.begin(), polygon.end());
  return polygon;
}

void pairing_in_space(Choices& choices) {
  const bool flat = choices.below(2) == 0;
  Skin slave = sheet(choices, false, 0, flat), master = sheet(choices, true, -3, flat);
  const Pairing found = pair(slave.view(3), master.view(3));
  const ContactCells& cells = found.cells;
  std::map<std::pair<std::int32_t, std::int32_t>, double> covered;  // in measures of the slave
  std::map<std::int32_t, double> of_slave;
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (auto p = static_cast<std::size_t>(cells.offset[c]); p < static_cast<std::size_t>(cells.offset[c + 1]); ++p) {
      const double r = cells.slave_point[2 * p], s = cells.slave_point[2 * p + 1];
      expect(r >= -1e-9 && s >= -1e-9 && r + s <= 1 + 1e-9, "an integration point lies in its slave");
      expect(std::isfinite(cells.master_point[2 * p]) && std::isfinite(cells.master_point[2 * p + 1]), "an image is a point");
      covered[{cells.slave[c], cells.master[c]}] += 2 * cells.weight[p];  // the reference triangle measures 1/2
      of_slave[cells.slave[c]] += 2 * cells.weight[p];
    }
  for (const auto& [e, part] : of_slave) expect(part <= 1 + 1e-9, "a slave is covered once at most");
  if (flat)
    for (std::size_t e = 0; e < slave.surface.size(); ++e)
      for (std::size_t m = 0; m < master.surface.size(); ++m) {
        const double whole = area(seen(slave, e)), common = common_area(seen(slave, e), seen(master, m));
        const auto own = covered.find({static_cast<std::int32_t>(e), static_cast<std::int32_t>(m)});
        expect(std::abs((own == covered.end() ? 0 : own->second) * whole - common) <= 1e-10 * whole,
               "parallel cells share what their polygons have in common");
      }
  expect_same_as_every_couple(slave.view(3), master.view(3), found);
}

}  // namespace

void pairing(Bytes input) {
  Choices choices(input);
  choices.below(2) == 0 ? pairing_in_plane(choices) : pairing_in_space(choices);
}

}  // namespace lacon::fuzz
