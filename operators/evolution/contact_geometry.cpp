#include "lacon/operators/evolution/contact_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "lacon/catalog/messages.hpp"
#include "lacon/elements/reference.hpp"
#include "lacon/pairing/normals.hpp"

namespace lacon {
namespace {

/// Coordinates of a cell's nodes, (n_nodes, dimension), behind `out`.
void append_points(const Mesh& mesh, std::span<const double> coordinates, std::int32_t cell, int dimension,
                   std::vector<double>& out) {
  for (const std::int32_t node : mesh.cells[cell])
    out.insert(out.end(), coordinates.begin() + 3 * std::ptrdiff_t{node},
               coordinates.begin() + 3 * std::ptrdiff_t{node} + dimension);
}

constexpr double tolerated_overlap = 0.1;     // of a slave cell's size, beyond the axis: a node there that nothing holds
constexpr std::size_t block = 256;            // slave cells whose points are in memory at a time
constexpr double coverage_round_off = 1e-12;  // covered fractions above 1 by no more than this are 1

}  // namespace

const Rule& measuring_rule(CellType type) {
  const auto& [family, order] = std::tie(catalog::cell(type).family, catalog::cell(type).order);
  return integration_rule(family, family == Family::SEG    ? 4
                                  : family == Family::TRIA ? (order == 1 ? 6 : 16)
                                                           : (order == 1 ? 9 : 25));
}

ContactGeometry::ContactGeometry(const Mesh& mesh, const Model& model, const Contact& contact, Registry& registry)
    : mesh_(mesh), model_(model), contact_(contact), registry_(registry), coordinates_(mesh.coordinates) {
  const std::size_t n = mesh.patches->size();
  gap_.assign(n, 0.0);
  weight_ = covered_ = whole_ = coverage_ = gap_;
  zone_of_.assign(n, -1);
  rejected_.assign(n_rejections, 0);

  std::map<std::int32_t, std::int32_t> slave_of_cell;
  for (std::size_t s = 0; s < contact_.slaves.size(); ++s)
    slave_of_cell[contact_.slaves[s].cell] = static_cast<std::int32_t>(s);
  for (const ContactZone& data : contact_.zones) {
    Zone zone{.slaves = {},
              .masters = data.master,
              .slave = surface_of(mesh, data.slave, coordinates_),
              .master = surface_of(mesh, data.master, coordinates_),
              .current_jacobian = data.jacobian == "ACTUALISE",
              .pairing = {.distance_limit = data.distance_limit}};
    for (const std::int32_t cell : data.slave) zone.slaves.push_back(slave_of_cell.at(cell));
    for (const std::int32_t patch : data.patches) zone_of_[patch] = static_cast<std::int32_t>(zones_.size());
    zones_.push_back(std::move(zone));
  }

  measure_slaves();
  check_radii();
}

void ContactGeometry::note(std::int32_t error, std::int32_t cell) {
  if (error == LACON_BAD_RADIUS)
    over_axis_ = cell;
  else if (error != LACON_FINE)
    fail("EVOLUTION_3", {{"cell", cell_name(cell)}});
}

void ContactGeometry::check_radii() const {
  if (over_axis_) {
    double least = 0, size = 0;
    const auto nodes = mesh_.cells[*over_axis_];
    for (const std::int32_t node : nodes) {
      const double* const x = coordinates_.data() + 3 * std::ptrdiff_t{node};
      const double* const first = coordinates_.data() + 3 * std::ptrdiff_t{nodes.front()};
      least = std::min(least, x[0]);
      size = std::max(size, std::hypot(x[0] - first[0], x[1] - first[1]));
    }
    if (least < -tolerated_overlap * size) fail("EVOLUTION_8", {{"cell", cell_name(*over_axis_)}});
  }
}

const lacon_kernel& ContactGeometry::kernel_of(std::int32_t cell) const {
  const std::int32_t element = model_.element[cell];
  const catalog::ElementRow* row = element < 0 ? nullptr : registry_.find_element(model_.elements[element]);
  if (!row) fail("PLUGIN_4", {{"element", element < 0 ? "none, on cell " + cell_name(cell) : model_.elements[element]}});
  return registry_.kernel(*row, "RIGI_CONT", LACON_CONTACT);
}

void ContactGeometry::measure_slaves() {
  const int dimension = mesh_.dimension;
  std::fill(whole_.begin(), whole_.end(), 0.0);
  std::map<std::int32_t, std::vector<std::int32_t>> by_element;  // one kernel, one kind of cell
  for (std::size_t s = 0; s < contact_.slaves.size(); ++s)
    by_element[model_.element[contact_.slaves[s].cell]].push_back(static_cast<std::int32_t>(s));
  for (const auto& [element, members] : by_element) {
    const CellType type = mesh_.types[contact_.slaves[members.front()].cell];
    const lacon_kernel& kernel = kernel_of(contact_.slaves[members.front()].cell);
    // each cell on itself: the kernel says what its measure is
    const Tabulation table = tabulate(type, measuring_rule(type));
    std::vector<std::int64_t> offset{0};
    std::vector<double> weight, shape, gradient, initial, current, size(block);
    std::vector<std::int32_t> error(block);
    for (std::size_t i = 0; i < std::min(block, members.size()); ++i) {
      weight.insert(weight.end(), table.weight.begin(), table.weight.end());
      shape.insert(shape.end(), table.shape.begin(), table.shape.end());
      gradient.insert(gradient.end(), table.gradient.begin(), table.gradient.end());
      offset.push_back(static_cast<std::int64_t>(weight.size()));
    }
    for (std::size_t first = 0; first < members.size(); first += block) {
      const auto some = std::span(members).subspan(first, std::min(block, members.size() - first));
      initial.clear();
      current.clear();
      for (const std::int32_t s : some) {
        append_points(mesh_, mesh_.coordinates, contact_.slaves[s].cell, dimension, initial);
        append_points(mesh_, coordinates_, contact_.slaves[s].cell, dimension, current);
      }
      std::fill(error.begin(), error.end(), LACON_FINE);
      const lacon_contact_batch batch{.struct_size = sizeof(lacon_contact_batch),
                                      .n_cells = static_cast<std::int32_t>(some.size()),
                                      .n_slave_nodes = table.n_nodes,
                                      .n_master_nodes = table.n_nodes,
                                      .dimension = dimension,
                                      .current_jacobian = 1,
                                      .offset = offset.data(),
                                      .weight = weight.data(),
                                      .slave_shape = shape.data(),
                                      .slave_gradient = gradient.data(),
                                      .master_shape = shape.data(),
                                      .slave_initial = initial.data(),
                                      .slave = current.data(),
                                      .master = current.data(),
                                      .slave_normal = nullptr,
                                      .point_gap = nullptr,
                                      .gap = nullptr,
                                      .measure = nullptr,
                                      .current_measure = size.data(),
                                      .coupling = nullptr,
                                      .error = error.data()};
      kernel.contact(&batch);
      for (std::size_t i = 0; i < some.size(); ++i) {
        const SlaveElement& slave = contact_.slaves[some[i]];
        note(error[i], slave.cell);
        whole_[slave.patch] += size[i];
      }
    }
  }
}

void ContactGeometry::update(std::span<const double> displacement, std::vector<ZonePairing>* records) {
  const int dimension = mesh_.dimension;
  for (std::size_t node = 0; node < mesh_.n_nodes(); ++node)
    for (int d = 0; d < dimension; ++d)
      coordinates_[3 * node + d] = mesh_.coordinates[3 * node + d] + displacement[node * dimension + d];
  over_axis_.reset();
  measure_slaves();
  cells_.clear();
  coupling_.clear();
  std::fill(rejected_.begin(), rejected_.end(), 0);
  for (std::vector<double>* sums : {&gap_, &weight_, &covered_}) std::fill(sums->begin(), sums->end(), 0.0);
  if (records) records->clear();
  for (Zone& zone : zones_) {
    std::vector<double> normals;
    if (contact_.smoothing) normals = nodal_normals(zone.slave);
    zone.slave.normals = normals;
    const auto take = [&](Pairing& pairing) {
      for (const RejectedCouple& couple : pairing.rejected) {
        if (couple.reason == Rejection::degenerate_slave)
          fail("EVOLUTION_3", {{"cell", cell_name(contact_.slaves[zone.slaves[couple.slave]].cell)}});
        ++rejected_[static_cast<std::size_t>(couple.reason)];
      }
      ZonePairing* record = nullptr;
      if (records) {
        record = &records->emplace_back();
        record->point_gap.resize(pairing.cells.weight.size());
        record->gap.resize(pairing.cells.size());
        record->measure.resize(pairing.cells.size());
      }
      integrate(zone, pairing.cells, normals, record);
      if (record) record->pairing = std::move(pairing);
    };
    // points of one block at a time; a record needs all of them
    pair_in_blocks(zone.slave, zone.master, zone.pairing, records ? std::max<std::size_t>(zone.slave.size(), 1) : block, take);
    zone.slave.normals = {};
  }
  for (std::size_t p = 0; p < gap_.size(); ++p) {
    if (weight_[p] > 0) gap_[p] /= weight_[p];
    coverage_[p] = whole_[p] > 0 ? covered_[p] / whole_[p] : 0;
    // what is above 1 by more is an error of quadrature or of pairing, and shows
    if (coverage_[p] > 1 && coverage_[p] <= 1 + coverage_round_off) coverage_[p] = 1;
  }
}

void ContactGeometry::integrate(const Zone& zone, const ContactCells& cells, std::span<const double> normals,
                                ZonePairing* record) {
  const int dimension = mesh_.dimension, reference = dimension - 1;
  // one kernel call for each slave element (which says the kernel and the kind of cell) and kind of master cell
  const auto slave_cell_of = [&](std::int32_t c) { return contact_.slaves[zone.slaves[cells.slave[c]]].cell; };
  std::map<std::pair<std::int32_t, CellType>, std::vector<std::int32_t>> by_kinds;
  for (std::int32_t c = 0; c < static_cast<std::int32_t>(cells.size()); ++c)
    by_kinds[{model_.element[slave_cell_of(c)], zone.master.types[cells.master[c]]}].push_back(c);

  for (const auto& [element_and_master, members] : by_kinds) {
    const std::int32_t first_cell = slave_cell_of(members.front());
    const std::pair kinds(mesh_.types[first_cell], element_and_master.second);
    const int ns = catalog::cell(kinds.first).n_nodes, nm = catalog::cell(kinds.second).n_nodes;
    std::vector<std::int64_t> offset{0};
    for (const std::int32_t c : members) offset.push_back(offset.back() + cells.offset[c + 1] - cells.offset[c]);
    const auto n_points = static_cast<std::size_t>(offset.back());
    std::vector<double> weight, slave_initial, slave, master, slave_normal;
    std::vector<double> slave_shape(n_points * ns), slave_gradient(slave_shape.size() * reference), master_shape(n_points * nm);
    weight.reserve(n_points);
    for (const std::int32_t c : members) {
      for (std::int64_t p = cells.offset[c]; p < cells.offset[c + 1]; ++p) {
        const std::span<const double> xi(cells.slave_point.data() + p * reference, reference),
            eta(cells.master_point.data() + p * reference, reference);
        const std::size_t at = weight.size(), width = static_cast<std::size_t>(ns) * reference;
        shape_functions(kinds.first, xi, std::span(slave_shape).subspan(at * ns, ns));
        shape_gradients(kinds.first, xi, std::span(slave_gradient).subspan(at * width, width));
        shape_functions(kinds.second, eta, std::span(master_shape).subspan(at * nm, nm));
        weight.push_back(cells.weight[p]);
      }
      const std::int32_t slave_cell = slave_cell_of(c), master_cell = zone.masters[cells.master[c]];
      append_points(mesh_, mesh_.coordinates, slave_cell, dimension, slave_initial);
      append_points(mesh_, coordinates_, slave_cell, dimension, slave);
      append_points(mesh_, coordinates_, master_cell, dimension, master);
      if (!normals.empty()) append_points(mesh_, normals, slave_cell, dimension, slave_normal);
    }
    const std::size_t width = static_cast<std::size_t>(ns + nm) * dimension;
    std::vector<double> point_gap(weight.size()), gap(members.size()), size(members.size()), current(members.size()),
        coupling(members.size() * width);
    std::vector<std::int32_t> error(members.size(), LACON_FINE);
    const lacon_contact_batch batch{.struct_size = sizeof(lacon_contact_batch),
                                    .n_cells = static_cast<std::int32_t>(members.size()),
                                    .n_slave_nodes = ns,
                                    .n_master_nodes = nm,
                                    .dimension = dimension,
                                    .current_jacobian = zone.current_jacobian,
                                    .offset = offset.data(),
                                    .weight = weight.data(),
                                    .slave_shape = slave_shape.data(),
                                    .slave_gradient = slave_gradient.data(),
                                    .master_shape = master_shape.data(),
                                    .slave_initial = slave_initial.data(),
                                    .slave = slave.data(),
                                    .master = master.data(),
                                    .slave_normal = normals.empty() ? nullptr : slave_normal.data(),
                                    .point_gap = point_gap.data(),
                                    .gap = gap.data(),
                                    .measure = size.data(),
                                    .current_measure = current.data(),
                                    .coupling = coupling.data(),
                                    .error = error.data()};
    kernel_of(first_cell).contact(&batch);
    for (std::size_t i = 0; i < members.size(); ++i) {
      const std::int32_t c = members[i], s = zone.slaves[cells.slave[c]];
      note(error[i], contact_.slaves[s].cell);
      const std::int32_t patch = contact_.slaves[s].patch;
      gap_[patch] += gap[i];
      weight_[patch] += size[i];
      covered_[patch] += current[i];
      if (record) {
        std::copy(point_gap.begin() + offset[i], point_gap.begin() + offset[i + 1],
                  record->point_gap.begin() + cells.offset[c]);
        record->gap[c] = gap[i] / size[i];
        record->measure[c] = current[i];
      }
      cells_.push_back({s, zone.masters[cells.master[c]], gap[i], static_cast<std::int64_t>(coupling_.size())});
      coupling_.insert(coupling_.end(), coupling.begin() + static_cast<std::ptrdiff_t>(i * width),
                       coupling.begin() + static_cast<std::ptrdiff_t>((i + 1) * width));
    }
  }
}

}  // namespace lacon
