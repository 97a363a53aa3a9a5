// The derivatives of the contact cells of a zone, from a pairing that says what polygons hang on.
#include <algorithm>

#include "lacon/operators/contact/contact_geometry.hpp"
#include "lacon/structures/parallel.hpp"

namespace lacon {

std::vector<ContactGeometry::Variation> ContactGeometry::vary(std::span<const std::int8_t> order) const {
  std::vector<Variation> all;
  if (contact_.frozen_gap) {
    for (const Cell& cell : cells_)
      if (order[contact_.slaves[cell.slave].patch] > 0) all.push_back(frozen_variation(cell));
    return all;
  }
  for (std::size_t z = 0; z < zones_.size(); ++z) {
    const Zone& zone = zones_[z];
    std::vector<std::size_t> slaves;  // cells of the zone
    for (std::size_t i = 0; i < zone.slaves.size(); ++i)
      if (order[contact_.slaves[zone.slaves[i]].patch] > 0) slaves.push_back(i);
    if (slaves.empty()) continue;
    PairingOptions options = zone.pairing;
    options.traced = true;
    PairingInParts pairing(zone.slave, zone.master, options);
    std::vector<std::vector<Variation>> found(slaves.size());
    constexpr std::size_t block = 4;  // slave cells that a thread takes at a time
    parallel_for(slaves.size(), block, [&](const LoopBlock& some) {
      Pairing pairs;
      for (std::size_t i = some.first; i < some.last; ++i) {
        pairing.pair(slaves[i], slaves[i] + 1, pairs);
        const bool second = order[contact_.slaves[zone.slaves[slaves[i]]].patch] > 1;
        for (std::size_t c = 0; c < pairs.cells.size(); ++c) found[i].push_back(variation(z, pairs, c, second));
      }
    });
    for (std::vector<Variation>& of_cell : found) std::move(of_cell.begin(), of_cell.end(), std::back_inserter(all));
  }
  return all;
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

ContactGeometry::Variation ContactGeometry::variation(std::size_t z, const Pairing& found, std::size_t place,
                                                      bool second) const {
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
      .current_jacobian = zone.current_jacobian};

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
      cell.ends[k] = {cells.vertex[vertex], node < 0 ? -1 : local(node)};
    }
  } else {
    cell.trace = &found.traces[place];
    for (const PolygonTrace::Line& line : cell.trace->line) {
      ContactCellGeometry::LineNodes& drawn_on = cell.lines.emplace_back();
      if (line.master < 0) continue;
      const std::int32_t owner = zone.masters[line.master];
      drawn_on.type = mesh_.types[owner];
      std::size_t a = 0;
      for (const std::int32_t node : mesh_.cells[owner]) drawn_on.node[a++] = local(node);
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
  vary_gap(cell, second, variation.of_gap);
  if (!contact_.smoothing) return variation;

  // normals hang on the nodes around: the slave's own nodes, those, then the others
  std::vector<std::int32_t> all(slave_nodes.begin(), slave_nodes.end());
  normal_variations_[z].append_nodes_around(zone.slave, slave_nodes, all);
  const auto n_on_slave = static_cast<int>(all.size());
  for (const std::int32_t node : std::span(nodes).subspan(slave_nodes.size()))
    if (std::find(all.begin(), all.end(), node) == all.end()) all.push_back(node);
  normal_variations_[z].apply(zone.slave, nodes, variation.n_slave_nodes, all, variation.of_gap);
  nodes = std::move(all);
  variation.n_slave_nodes = n_on_slave;
  return variation;
}

}  // namespace lacon
