#include "lacon/operators/meshing/checks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <string>

#include "lacon/catalog/messages.hpp"
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
    if (!is_sound({-range.greatest, -range.least})) {
      const std::string groups = groups_with(mesh, cell);
      fail("LIRE_2", {{"cell", cell_name(cell)},
                      {"type", std::string(row.name)},
                      {"groups", groups.empty() ? "" : ", of the group " + groups},
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
  std::vector<std::int32_t> reversed;
  for (std::size_t c = 0; c < mesh.n_cells(); ++c) {
    if (mesh.row(c).dimension != mesh.dimension) continue;
    const std::span<std::int32_t> nodes = mesh.cells[c];
    if (central_jacobian(mesh.types[c], nodes, mesh.coordinates) >= 0) continue;
    std::ranges::copy(mirrored(mesh.types[c], nodes), nodes.begin());
    reversed.push_back(static_cast<std::int32_t>(c));
  }
  tell("LIRE_1", reversed, cell_name);
}

void inspect(const Mesh& mesh, double flatness) {
  std::vector<bool> used(mesh.n_nodes(), false);
  for (const std::int32_t node : mesh.cells.values) used[static_cast<std::size_t>(node)] = true;
  std::vector<std::int32_t> orphans;
  for (std::size_t i = 0; i < used.size(); ++i)
    if (!used[i]) orphans.push_back(static_cast<std::int32_t>(i));
  tell("LIRE_3", orphans, node_name);

  // cells of one type with the same set of nodes follow each other once sorted
  std::vector<std::vector<std::int32_t>> sorted(mesh.n_cells());
  for (std::size_t c = 0; c < mesh.n_cells(); ++c) {
    sorted[c].assign(mesh.cells[c].begin(), mesh.cells[c].end());
    std::sort(sorted[c].begin(), sorted[c].end());
  }
  std::vector<std::int32_t> order(mesh.n_cells()), twins;
  std::iota(order.begin(), order.end(), 0);
  const auto at = [&](std::int32_t c) -> const std::vector<std::int32_t>& { return sorted[static_cast<std::size_t>(c)]; };
  std::sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) { return at(a) != at(b) ? at(a) < at(b) : a < b; });
  for (std::size_t i = 1; i < order.size(); ++i)
    if (at(order[i]) == at(order[i - 1])) twins.push_back(order[i]);
  std::sort(twins.begin(), twins.end());
  tell("LIRE_4", twins, cell_name);

  std::vector<std::int32_t> flat;
  for (std::size_t c = 0; c < mesh.n_cells(); ++c) {
    const auto vertices = mesh.cells[c].first(static_cast<std::size_t>(mesh.row(c).n_vertices));
    double least = INFINITY, greatest = 0;
    for (std::size_t i = 0; i < vertices.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        double square = 0;
        for (std::size_t k = 0; k < 3; ++k)
          square += std::pow(
              mesh.point(static_cast<std::size_t>(vertices[i]))[k] - mesh.point(static_cast<std::size_t>(vertices[j]))[k], 2);
        least = std::min(least, std::sqrt(square));
        greatest = std::max(greatest, std::sqrt(square));
      }
    if (vertices.size() > 1 && least <= flatness * greatest) flat.push_back(static_cast<std::int32_t>(c));
  }
  tell("LIRE_5", flat, cell_name);
}

}  // namespace lacon
