#include "lacon/operators/meshing/checks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <string>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/elements/lanes.hpp"
#include "lacon/operators/meshing/body.hpp"
#include "lacon/operators/meshing/quality.hpp"

namespace lacon {
namespace {

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

/// The first few of these names, and how many more there are.
template <class Name>
std::string some(const std::vector<std::int32_t>& numbers, Name name) {
  constexpr std::size_t shown = 5;
  std::string text;
  for (std::size_t i = 0; i < std::min(shown, numbers.size()); ++i) text += (i ? ", " : "") + name(numbers[i]);
  return text + (numbers.size() > shown ? ", ..." : "");
}

/// The cells that have the same set of nodes as a cell before them.
std::vector<std::int32_t> twins(const Mesh& mesh) {
  // only cells that share their lowest node are compared, and of these those whose sum of scattered node numbers is the same
  const auto lowest = [&](std::size_t c) { return static_cast<std::size_t>(std::ranges::min(mesh.cells[c])); };
  const auto digest = [&](std::size_t c) {
    std::uint64_t sum = 0;
    for (const std::int32_t node : mesh.cells[c]) {
      const std::uint64_t scattered = (static_cast<std::uint64_t>(node) + 1) * 0x9E3779B97F4A7C15u;
      sum += scattered ^ (scattered >> 32);
    }
    return sum;
  };
  const auto same = [&](std::int32_t a, std::int32_t b) {
    return std::ranges::is_permutation(mesh.cells[static_cast<std::size_t>(a)], mesh.cells[static_cast<std::size_t>(b)]);
  };
  std::vector<std::int32_t> start(mesh.n_nodes() + 1, 0);  // of the cells of each lowest node
  for (std::size_t c = 0; c < mesh.n_cells(); ++c) ++start[lowest(c)];
  std::exclusive_scan(start.begin(), start.end(), start.begin(), 0);
  std::vector<std::pair<std::uint64_t, std::int32_t>> cells(mesh.n_cells());
  for (std::size_t c = 0; c < mesh.n_cells(); ++c)
    cells[static_cast<std::size_t>(start[lowest(c)]++)] = {digest(c), static_cast<std::int32_t>(c)};
  std::vector<std::int32_t> found;
  for (std::size_t n = 0, first = 0; n < mesh.n_nodes(); ++n) {
    const auto end = static_cast<std::size_t>(start[n]);  // has moved there
    std::sort(cells.begin() + static_cast<std::ptrdiff_t>(first), cells.begin() + static_cast<std::ptrdiff_t>(end));
    for (std::size_t i = first + 1; i < end; ++i)
      for (std::size_t j = i; j-- > first && cells[j].first == cells[i].first;)
        if (same(cells[i].second, cells[j].second)) {
          found.push_back(cells[i].second);
          break;
        }
    first = end;
  }
  std::ranges::sort(found);
  return found;
}

/// Whether the least distance between two of the vertices is at most `flatness` times the greatest.
LACON_KERNEL bool is_flat(std::span<const std::int32_t> vertices, std::span<const double> coordinates, double flatness) {
  double place[3][LACON_LANES];
  for (std::size_t i = 0; i < LACON_LANES; ++i) {
    const auto node = static_cast<std::size_t>(vertices[i < vertices.size() ? i : 0]);
    for (std::size_t k = 0; k < 3; ++k) place[k][i] = coordinates[3 * node + k];
  }
  const Lanes x = lanes(place[0], 0), y = lanes(place[1], 0), z = lanes(place[2], 0), rank = {0, 1, 2, 3, 4, 5, 6, 7},
              infinite = Lanes{} + INFINITY;
  Lanes least = infinite, greatest = {};
  for (std::size_t v = 1; v < vertices.size(); ++v) {
    const Lanes dx = x - x[v], dy = y - y[v], dz = z - z[v], square = dx * dx + dy * dy + dz * dz,
                before = rank < Lanes{} + static_cast<double>(v) ? square : infinite;  // each pair once, no vertex with itself
    least = before < least ? before : least;
    greatest = square > greatest ? square : greatest;
  }
  double shortest = INFINITY, longest = 0;
  for (int i = 0; i < LACON_LANES; ++i) {
    shortest = std::min(shortest, least[i]);
    longest = std::max(longest, greatest[i]);
  }
  return std::sqrt(shortest) <= flatness * std::sqrt(longest);
}

void tell(std::string_view id, const std::vector<std::int32_t>& numbers, std::string (*name)(std::int64_t)) {
  if (!numbers.empty()) inform(id, {{"count", std::to_string(numbers.size())}, {"some", some(numbers, name)}});
}

}  // namespace

std::string groups_with(const Mesh& mesh, std::int32_t cell) {
  std::string names;
  for (const Group& group : mesh.cell_groups)
    if (std::find(group.members.begin(), group.members.end(), cell) != group.members.end())
      names += (names.empty() ? "" : ", ") + group.name;
  return names;
}

std::vector<std::int32_t> orient_body_cells(Mesh& mesh) {
  std::vector<std::int32_t> reversed;
  for (std::size_t c = 0; c < mesh.n_cells(); ++c) {
    const catalog::CellRow& row = mesh.row(c);
    if (row.dimension != mesh.dimension) continue;
    const std::span<std::int32_t> nodes = mesh.cells[c];
    const JacobianRange range = jacobian_range(row.type, nodes, mesh.coordinates);
    if (is_sound(range)) continue;
    const auto cell = static_cast<std::int32_t>(c);
    if (!is_sound({-range.greatest, -range.least, -range.central})) {
      const std::string groups = groups_with(mesh, cell);
      fail("LIRE_2", {{"cell", cell_name(cell)},
                      {"type", std::string(row.name)},
                      {"groups", groups.empty() ? "" : part("of_the_group", {{"groups", groups}})},
                      {"least", number(range.least)},
                      {"greatest", number(range.greatest)}});
    }
    std::ranges::copy(mirrored(row.type, nodes), nodes.begin());
    reversed.push_back(cell);
  }
  tell("LIRE_1", reversed, cell_name);
  return reversed;
}

void turn_body_cells(Mesh& mesh) {
  const std::vector<std::int32_t> inverted = inverted_cells(mesh);
  for (const std::int32_t cell : inverted) {
    const auto c = static_cast<std::size_t>(cell);
    std::ranges::copy(mirrored(mesh.types[c], mesh.cells[c]), mesh.cells[c].begin());
  }
  tell("LIRE_1", inverted, cell_name);
}

namespace {

struct Extent {
  double size = 0,
         distance = 0;  ///< of the box around its cells; of the farthest node of a cell from the origin, along an axis
};

Extent extent_of(const Mesh& mesh) {
  Extent extent;
  double least[3], greatest[3];
  std::fill_n(least, 3, INFINITY);
  std::fill_n(greatest, 3, -INFINITY);
  for (const std::int32_t node : mesh.cells.values)
    for (std::size_t k = 0; k < 3; ++k) {
      const double x = mesh.coordinates[3 * static_cast<std::size_t>(node) + k];
      least[k] = std::min(least[k], x);
      greatest[k] = std::max(greatest[k], x);
      extent.distance = std::max(extent.distance, std::abs(x));
    }
  for (std::size_t k = 0; k < 3; ++k) extent.size = std::max(extent.size, greatest[k] - least[k]);
  return extent;
}

/// Tells of a mesh that lies so far from the origin, for its size, that results keep less than the eight digits that are
/// promised: a coordinate is exact to 1e-16 of itself, and results of a block that was moved follow it with a hundred times
/// that, in parts of its size.
void tell_distance(const Mesh& mesh) {
  const auto [size, distance] = extent_of(mesh);
  if (size > 0 && distance > 1e6 * size)
    inform("LIRE_6", {{"size", number(size)},
                      {"distance", number(distance)},
                      {"digits", number(std::floor(15.95 - std::log10(distance / size)))}});
}

}  // namespace

void check_places(const Mesh& mesh) {
  constexpr double largest = 1e50, smallest = 1e-50;
  const auto far = std::ranges::find_if(mesh.coordinates, [](double x) { return !(std::abs(x) <= largest); });
  if (far != mesh.coordinates.end())
    fail("LIRE_8", {{"node", node_name((far - mesh.coordinates.begin()) / 3)},
                    {"axis", std::string(1, "XYZ"[(far - mesh.coordinates.begin()) % 3])},
                    {"value", number(*far)},
                    {"largest", number(largest)}});
  const double size = extent_of(mesh).size;
  if (size > 0 && size < smallest) fail("LIRE_9", {{"size", number(size)}, {"smallest", number(smallest)}});
}

void inspect(const Mesh& mesh, double flatness) {
  std::vector<char> used(mesh.n_nodes(), 0);
  for (const std::int32_t node : mesh.cells.values) used[static_cast<std::size_t>(node)] = 1;
  std::vector<std::int32_t> orphans;
  for (std::size_t i = 0; i < used.size(); ++i)
    if (!used[i]) orphans.push_back(static_cast<std::int32_t>(i));
  tell("LIRE_3", orphans, node_name);

  std::vector<std::int32_t> copies = twins(mesh);
  const auto first_body = std::stable_partition(copies.begin(), copies.end(), [&](std::int32_t cell) {
    return mesh.row(static_cast<std::size_t>(cell)).dimension < mesh.dimension;
  });
  tell("LIRE_4", {copies.begin(), first_body}, cell_name);
  tell("LIRE_7", {first_body, copies.end()}, cell_name);

  std::vector<std::int32_t> flat;
  for (std::size_t c = 0; c < mesh.n_cells(); ++c) {
    const auto vertices = mesh.cells[c].first(static_cast<std::size_t>(mesh.row(c).n_vertices));
    if (vertices.size() > 1 && is_flat(vertices, mesh.coordinates, flatness)) flat.push_back(static_cast<std::int32_t>(c));
  }
  tell("LIRE_5", flat, cell_name);

  tell_distance(mesh);
}

}  // namespace lacon
