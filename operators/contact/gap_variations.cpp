// The derivatives of the contact cells of a zone, from a pairing that says what polygons hang on.
#include <algorithm>
#include <cmath>

#include "lacon/operators/contact/contact_geometry.hpp"
#include "lacon/pairing/thickness.hpp"
#include "lacon/structures/parallel.hpp"

namespace lacon {
namespace {

/// The contact cells of a slave cell as one: in space a curved one has dozens, of the same nodes but for a few. Behind the
/// nodes there may be as many nodal normals as slave nodes.
ContactGeometry::Variation sum_of(std::span<const ContactGeometry::Variation> cells, int dimension) {
  ContactGeometry::Variation sum;
  if (cells.empty()) return sum;
  sum.slave = cells[0].slave;
  sum.n_slave_nodes = cells[0].n_slave_nodes;  // all begin with the same ones
  sum.nodes.assign(cells[0].nodes.begin(), cells[0].nodes.begin() + sum.n_slave_nodes);
  // a node of both skins counts twice
  const auto find = [&](std::int32_t node) { return std::find(sum.nodes.begin() + sum.n_slave_nodes, sum.nodes.end(), node); };
  for (const ContactGeometry::Variation& cell : cells)
    for (const std::int32_t node : std::span(cell.nodes).subspan(static_cast<std::size_t>(sum.n_slave_nodes)))
      if (find(node) == sum.nodes.end()) sum.nodes.push_back(node);
  const auto d = static_cast<std::size_t>(dimension), n_normals = cells[0].of_gap.gradient.size() - cells[0].nodes.size() * d,
             n = sum.nodes.size() * d + n_normals;
  sum.of_gap.gradient.assign(n, 0.0);
  sum.of_gap.hessian.assign(cells[0].of_gap.hessian.empty() ? 0 : n * n, 0.0);
  std::vector<std::size_t> place;
  for (const ContactGeometry::Variation& cell : cells) {
    place.clear();
    for (std::size_t i = 0; i < cell.nodes.size(); ++i) {
      const bool of_slave = i < static_cast<std::size_t>(sum.n_slave_nodes);
      const std::size_t at = of_slave ? i : static_cast<std::size_t>(find(cell.nodes[i]) - sum.nodes.begin());
      for (std::size_t k = 0; k < d; ++k) place.push_back(d * at + k);
    }
    for (std::size_t k = 0; k < n_normals; ++k) place.push_back(n - n_normals + k);
    sum.of_gap.gap += cell.of_gap.gap;
    const std::vector<double>&gradient = cell.of_gap.gradient, &hessian = cell.of_gap.hessian;
    for (std::size_t i = 0; i < place.size(); ++i) {
      sum.of_gap.gradient[place[i]] += gradient[i];
      for (std::size_t j = 0; j < place.size() && !hessian.empty(); ++j)
        sum.of_gap.hessian[place[i] * n + place[j]] += hessian[i * place.size() + j];
    }
    for (const MovingEnd& end : cell.of_gap.ends) {
      MovingEnd& same = sum.of_gap.ends.emplace_back(end.gap, std::vector<double>(n), std::vector<double>(n));
      for (std::size_t i = 0; i < place.size(); ++i) {
        same.gradient[place[i]] += end.gradient[i];
        same.place[place[i]] += end.place[i];
      }
    }
  }
  return sum;
}

/// In the plane: the share that a contact cell counts by (steepness.hpp).
double share_of(const ContactCells& cells, std::size_t place) {
  double sum = 0;
  for (auto p = static_cast<std::size_t>(cells.offset[place]); p < static_cast<std::size_t>(cells.offset[place + 1]); ++p)
    sum += cells.weight[p];
  return sum / (cells.vertex[2 * place + 1] - cells.vertex[2 * place]);
}

/// In the plane: whether no other contact cell of the slave cell goes on there by the same share.
/// @param cells those of one slave cell
bool ends_cover(const ContactCells& cells, std::size_t vertex) {
  constexpr double round_off = 1e-9;
  const std::size_t place = vertex / 2;
  for (std::size_t other = 0; other < cells.size(); ++other)
    if (other != place &&
        (cells.vertex[2 * other] == cells.vertex[vertex] || cells.vertex[2 * other + 1] == cells.vertex[vertex]))
      return std::abs(share_of(cells, other) - share_of(cells, place)) > round_off;
  return true;
}

/// The edge of a facet that a line lies on, if it does. @param from, to in reference coordinates
std::optional<int> edge_along(CellType type, const std::array<double, 2>& from, const std::array<double, 2>& to) {
  const bool quadrangle = catalog::cell(type).family == Family::QUAD;
  for (int edge = 0; edge < (quadrangle ? 4 : 3); ++edge) {
    const auto off = [&](const std::array<double, 2>& at) {
      if (quadrangle) return edge % 2 == 0 ? at[1] - (edge - 1) : at[0] + (edge - 2);
      return edge == 0 ? at[1] : edge == 1 ? 1 - at[0] - at[1] : at[0];
    };
    constexpr double round_off = 1e-12;
    if (std::abs(off(from)) < round_off && std::abs(off(to)) < round_off) return edge;
  }
  return std::nullopt;
}

}  // namespace

std::vector<ContactGeometry::Variation> ContactGeometry::vary(std::span<const std::int8_t> order,
                                                              const std::vector<bool>& still) const {
  std::vector<Variation> all;
  std::vector<std::int8_t> left(order.begin(), order.end());
  for (std::size_t p = 0; p < left.size(); ++p)
    if (contact_.frozen_gap || (left[p] == 1 && coincides(p))) left[p] = 0;
  for (const Cell& cell : cells_)
    if (const std::int32_t patch = contact_.slaves[cell.slave].patch; order[patch] > left[patch])
      all.push_back(frozen_variation(cell));
  if (contact_.frozen_gap) return all;
  const WaysWhenAsked ways({&boundary_});
  for (std::size_t z = 0; z < zones_.size(); ++z) {
    const Zone& zone = zones_[z];
    std::vector<std::size_t> slaves;  // cells of the zone
    for (std::size_t i = 0; i < zone.slaves.size(); ++i)
      if (left[contact_.slaves[zone.slaves[i]].patch] > 0) slaves.push_back(i);
    if (slaves.empty()) continue;
    PairingOptions options = zone.pairing;
    options.ways = &ways;
    options.traced = true;
    PairingInParts pairing(zone.slave, zone.master, options);
    const std::size_t before = all.size();
    all.resize(before + slaves.size());
    constexpr std::size_t block = 4;  // slave cells that a thread takes at a time
    parallel_for(slaves.size(), block, [&](const LoopBlock& some) {
      Pairing pairs;
      std::vector<Variation> found;
      for (std::size_t i = some.first; i < some.last; ++i) {
        const auto patch = static_cast<std::size_t>(contact_.slaves[zone.slaves[slaves[i]]].patch);
        pairing.pair(slaves[i], slaves[i] + 1, pairs, order[patch]);
        found.clear();
        for (std::size_t c = 0; c < pairs.cells.size(); ++c)
          found.push_back(variation(z, pairs, c, order[patch] > 1, !still.empty() && still[patch]));
        all[before + i] = sum_of(found, mesh_.dimension);
        if (contact_.smoothing && !found.empty()) chain_normals(z, slaves[i], all[before + i]);
      }
    });
    std::erase_if(all, [](const Variation& variation) { return variation.slave < 0; });  // slave cells without a master
  }
  return all;
}

bool ContactGeometry::coincides(std::size_t patch) const {
  constexpr double round_off = 1e-12;  // of the patch: what this leaves of a gap changes forces as much
  const double size = mesh_.dimension == 3 ? std::sqrt(whole_[patch]) : whole_[patch];
  return straight_[patch] != 0 && !contact_.smoothing && !has_offset(static_cast<std::size_t>(zone_of_[patch])) &&
         largest_gap_[patch] <= round_off * size;
}

ContactGeometry::Variation ContactGeometry::frozen_variation(const Cell& cell) const {
  const auto slave_nodes = mesh_.cells[contact_.slaves[cell.slave].cell], master_nodes = mesh_.cells[cell.master];
  Variation variation{.slave = cell.slave, .nodes = {slave_nodes.begin(), slave_nodes.end()}};
  variation.n_slave_nodes = static_cast<int>(slave_nodes.size());
  variation.nodes.insert(variation.nodes.end(), master_nodes.begin(), master_nodes.end());
  const auto first = coupling_.begin() + cell.coupling;
  variation.of_gap.gap = cell.gap;
  variation.of_gap.gradient.assign(first, first + static_cast<std::ptrdiff_t>(variation.nodes.size()) * mesh_.dimension);
  return variation;
}

ContactGeometry::Variation ContactGeometry::variation(std::size_t z, const Pairing& found, std::size_t place, bool second,
                                                      bool still) const {
  const Zone& zone = zones_[z];
  const ContactCells& cells = found.cells;
  const auto dimension = static_cast<std::size_t>(mesh_.dimension);
  Variation variation{.slave = zone.slaves[cells.slave[place]]};
  const std::int32_t slave_cell = contact_.slaves[variation.slave].cell, master_cell = zone.masters[cells.master[place]];
  const auto slave_nodes = mesh_.cells[slave_cell], master_nodes = mesh_.cells[master_cell];
  std::vector<std::int32_t>& nodes = variation.nodes;
  nodes.assign(slave_nodes.begin(), slave_nodes.end());
  nodes.insert(nodes.end(), master_nodes.begin(), master_nodes.end());
  variation.n_slave_nodes = static_cast<int>(slave_nodes.size());
  ContactCellGeometry cell{
      .slave = mesh_.types[slave_cell],
      .master = mesh_.types[master_cell],
      .dimension = mesh_.dimension,
      .axis = registry_.find_element(model_.elements[model_.element[slave_cell]])->geometry == catalog::Geometry::axis,
      .current_jacobian = zone.current_jacobian,
      .steep = steep_cosine(zone.pairing)};

  // nodes of other masters that bound the polygon come behind
  const auto local = [&](std::int32_t node) {
    const auto first = nodes.begin() + variation.n_slave_nodes;
    auto at = std::find(first, nodes.end(), node);
    if (at == nodes.end()) at = nodes.insert(at, node);
    return static_cast<int>(at - nodes.begin());
  };
  if (dimension == 2) {
    for (std::size_t k = 0; k < 2; ++k) {
      const std::size_t vertex = 2 * place + k;
      const std::int32_t node = cells.vertex_node[vertex];
      const bool fixed = still && node >= 0 && ends_cover(cells, vertex);
      cell.ends[k] = {cells.vertex[vertex], node >= 0 && !(fixed && !second) ? local(node) : -1, cells.vertex_crossing[vertex],
                      fixed};
    }
    cell.fading = zone.pairing.fading;
  } else {
    cell.trace = &found.traces[place];
    for (const PolygonTrace::Line& line : cell.trace->line) {
      ContactCellGeometry::LineNodes& drawn_on = cell.lines.emplace_back();
      if (line.master < 0) continue;
      const std::int32_t owner = zone.masters[line.master];
      drawn_on.type = mesh_.types[owner];
      std::size_t a = 0;
      for (const std::int32_t node : mesh_.cells[owner]) drawn_on.node[a++] = local(node);
      const std::optional<int> edge = edge_along(drawn_on.type, line.from, line.to);
      drawn_on.still =
          still && edge &&
          ends_at(zone, static_cast<std::size_t>(cells.slave[place]), static_cast<std::size_t>(line.master), *edge);
    }
  }

  std::vector<double> initial, now, normals;
  for (const std::int32_t node : nodes) {
    const std::size_t first = 3 * static_cast<std::size_t>(node);
    initial.insert(initial.end(), mesh_.coordinates.begin() + first, mesh_.coordinates.begin() + first + dimension);
    now.insert(now.end(), coordinates_.begin() + first, coordinates_.begin() + first + dimension);
  }
  const std::size_t of_slave = slave_nodes.size() * dimension, of_master = master_nodes.size() * dimension;
  cell.slave_initial = std::span(initial).first(of_slave);
  cell.slave_nodes = std::span(now).first(of_slave);
  cell.master_nodes = std::span(now).subspan(of_slave, of_master);
  cell.other_nodes = std::span(now).subspan(of_slave + of_master);
  if (contact_.smoothing)
    for (const std::int32_t node : slave_nodes) {
      const auto first = normals_[z].begin() + 3 * std::ptrdiff_t{node};
      normals.insert(normals.end(), first, first + static_cast<std::ptrdiff_t>(dimension));
    }
  cell.slave_normals = normals;
  const auto first = static_cast<std::size_t>(cells.offset[place]),
             count = static_cast<std::size_t>(cells.offset[place + 1]) - first;
  cell.slave_point = std::span(cells.slave_point).subspan(first * (dimension - 1), count * (dimension - 1));
  cell.master_point = std::span(cells.master_point).subspan(first * (dimension - 1), count * (dimension - 1));
  cell.weight = std::span(cells.weight).subspan(first, count);
  std::vector<double> offset;
  if (has_offset(z)) {
    for (const std::int32_t node : slave_nodes) offset.push_back(offsets_[z][static_cast<std::size_t>(node)]);
    cell.slave_offset = offset;
  }
  vary_gap(cell, second, variation.of_gap);
  return variation;
}

bool ContactGeometry::ends_at(const Zone& zone, std::size_t slave, std::size_t master, int edge) const {
  const std::int32_t behind = zone.neighbours[master][static_cast<std::size_t>(edge)];
  if (behind < 0) return true;
  const Couple couple{static_cast<std::int32_t>(slave), behind};
  if (std::ranges::binary_search(zone.left_out, couple)) return true;
  const auto other = static_cast<std::size_t>(behind);
  return zone.faces[other] != zone.faces[master] && was_wall(zone.slave, slave, zone.master, other);
}

void ContactGeometry::chain_normals(std::size_t z, std::size_t slave, Variation& variation) const {
  const Surface& skin = zones_[z].slave;
  std::vector<std::int32_t>& nodes = variation.nodes;
  const auto own = skin.nodes[slave];
  std::vector<std::int32_t> all(own.begin(), own.end());
  normal_variations_[z].append_nodes_around(skin, own, all);
  const auto n_on_slave = static_cast<int>(all.size());
  for (const std::int32_t node : std::span(nodes).subspan(own.size()))
    if (std::find(all.begin(), all.end(), node) == all.end()) all.push_back(node);
  normal_variations_[z].apply(skin, nodes, variation.n_slave_nodes, all, variation.of_gap);
  nodes = std::move(all);
  variation.n_slave_nodes = n_on_slave;
}

}  // namespace lacon
