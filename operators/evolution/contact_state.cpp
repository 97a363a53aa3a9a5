#include "lacon/operators/evolution/contact_state.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "lacon/catalog/contact.hpp"
#include "lacon/catalog/messages.hpp"
#include "lacon/elements/contact_system.hpp"
#include "lacon/operators/meshing/body.hpp"
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

/// The rule that measures a whole skin cell.
const Rule& measuring_rule(Family family) {
  return integration_rule(family, family == Family::SEG ? 4 : family == Family::TRIA ? 6 : 9);
}

/// Length or area of a skin cell.
double measure(const Mesh& mesh, std::span<const double> coordinates, std::int32_t cell) {
  const catalog::CellRow& row = mesh.row(cell);
  const Rule& rule = measuring_rule(row.family);
  std::vector<double> points;
  append_points(mesh, coordinates, cell, 3, points);
  double sum = 0;
  for (int p = 0; p < rule.size(); ++p) {
    const auto n = cell_normal(row.type, points, std::span(rule.points).subspan(p * rule.dimension, rule.dimension));
    sum += rule.weights[p] * std::hypot(n[0], n[1], n[2]);
  }
  return sum;
}

[[noreturn]] void refuse_slave(std::int32_t cell, std::int32_t error) {
  fail(error == LACON_BAD_RADIUS ? "EVOLUTION_8" : "EVOLUTION_3", {{"cell", cell_name(cell)}});
}

}  // namespace

ContactState::ContactState(const StaticProblem& problem)
    : problem_(problem), contact_(*problem.contact), coordinates_(problem.mesh.coordinates) {
  const Mesh& mesh = problem.mesh;
  const std::size_t n = mesh.patches->size();
  gap_.assign(n, 0.0);
  weight_ = covered_ = whole_ = coverage_ = size_ = rho_ = gap_;
  zone_of_.assign(n, -1);
  locked_.assign(n, false);
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
              .pairing = {.distance_limit = data.distance_limit},
              .initial_status = data.initial_status};
    for (const std::int32_t cell : data.slave) zone.slaves.push_back(slave_of_cell.at(cell));
    for (const std::int32_t patch : data.patches) zone_of_[patch] = static_cast<std::int32_t>(zones_.size());
    zone.smallest_edge = std::min(smallest_edge(zone.slave), smallest_edge(zone.master));
    zones_.push_back(std::move(zone));
  }

  measure_slaves();
  const NodeCells around(mesh);
  for (const SlaveElement& slave : contact_.slaves) size_[slave.patch] += measure(mesh, coordinates_, slave.cell);
  if (mesh.dimension == 3)
    for (double& size : size_) size = std::sqrt(size);
  for (const SlaveElement& slave : contact_.slaves) {
    // the first sub-cell's body stands for the patch: all its sub-cells come from one body cell
    if (slave.rank > 0) continue;
    std::optional<double> modulus;
    for (const BodyCell& body : body_cells(mesh, around, slave.cell))
      if (problem.materials->has(body.cell)) modulus = problem.materials->find(body.cell, "ELAS/E");
    if (!modulus) fail("EVOLUTION_2", {{"cell", cell_name(slave.cell)}});
    rho_[slave.patch] = *modulus / size_[slave.patch];
  }
  double extent = 0;
  for (int d = 0; d < mesh.dimension; ++d) {
    double low = INFINITY, high = -INFINITY;
    for (std::size_t i = 0; i < mesh.n_nodes(); ++i) {
      low = std::min(low, mesh.coordinates[3 * i + d]);
      high = std::max(high, mesh.coordinates[3 * i + d]);
    }
    extent = std::max({extent, std::abs(low), std::abs(high)});
  }
  gap_tolerance_ = tolerances_.gap_round_off * extent;
}

const lacon_kernel& ContactState::kernel_of(std::int32_t cell) const {
  const std::int32_t element = problem_.model.element[cell];
  const catalog::ElementRow* row = element < 0 ? nullptr : problem_.registry->find_element(problem_.model.elements[element]);
  if (!row)
    fail("PLUGIN_4", {{"element", element < 0 ? "none, on cell " + cell_name(cell) : problem_.model.elements[element]}});
  return problem_.registry->kernel(*row, "RIGI_CONT", LACON_CONTACT);
}

void ContactState::measure_slaves() {
  const Mesh& mesh = problem_.mesh;
  const int dimension = problem_.dimension;
  std::fill(whole_.begin(), whole_.end(), 0.0);
  std::map<std::int32_t, std::vector<std::int32_t>> by_element;  // one kernel, one kind of cell
  for (std::size_t s = 0; s < contact_.slaves.size(); ++s)
    by_element[problem_.model.element[contact_.slaves[s].cell]].push_back(static_cast<std::int32_t>(s));
  for (const auto& [element, members] : by_element) {
    const CellType type = mesh.types[contact_.slaves[members.front()].cell];
    // each cell on itself: the kernel says what its measure is
    const Tabulation table = tabulate(type, measuring_rule(catalog::cell(type).family));
    std::vector<std::int64_t> offset{0};
    std::vector<double> weight, shape, gradient, initial, current, size(members.size());
    for (const std::int32_t s : members) {
      append_points(mesh, mesh.coordinates, contact_.slaves[s].cell, dimension, initial);
      append_points(mesh, coordinates_, contact_.slaves[s].cell, dimension, current);
      weight.insert(weight.end(), table.weight.begin(), table.weight.end());
      shape.insert(shape.end(), table.shape.begin(), table.shape.end());
      gradient.insert(gradient.end(), table.gradient.begin(), table.gradient.end());
      offset.push_back(static_cast<std::int64_t>(weight.size()));
    }
    std::vector<std::int32_t> error(members.size(), LACON_FINE);
    const lacon_contact_batch batch{.struct_size = sizeof(lacon_contact_batch),
                                    .n_cells = static_cast<std::int32_t>(members.size()),
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
    kernel_of(contact_.slaves[members.front()].cell).contact(&batch);
    for (std::size_t i = 0; i < members.size(); ++i) {
      const SlaveElement& slave = contact_.slaves[members[i]];
      if (error[i] != LACON_FINE) refuse_slave(slave.cell, error[i]);
      whole_[slave.patch] += size[i];
    }
  }
}

void ContactState::update_geometry(std::span<const double> displacement) {
  const int dimension = problem_.dimension;
  for (std::size_t node = 0; node < problem_.mesh.n_nodes(); ++node)
    for (int d = 0; d < dimension; ++d)
      coordinates_[3 * node + d] = problem_.mesh.coordinates[3 * node + d] + displacement[node * dimension + d];
  measure_slaves();
  cells_.clear();
  coupling_.clear();
  std::fill(rejected_.begin(), rejected_.end(), 0);
  for (std::vector<double>* sums : {&gap_, &weight_, &covered_}) std::fill(sums->begin(), sums->end(), 0.0);
  for (Zone& zone : zones_) {
    std::vector<double> normals;
    if (contact_.smoothing) normals = nodal_normals(zone.slave);
    zone.slave.normals = normals;
    const Pairing pairing = pair(zone.slave, zone.master, zone.pairing);
    zone.slave.normals = {};
    for (const RejectedCouple& couple : pairing.rejected) {
      if (couple.reason == Rejection::degenerate_slave)
        fail("EVOLUTION_3", {{"cell", cell_name(contact_.slaves[zone.slaves[couple.slave]].cell)}});
      ++rejected_[static_cast<std::size_t>(couple.reason)];
    }
    integrate(zone, pairing.cells, normals);
  }
  for (std::size_t p = 0; p < gap_.size(); ++p) {
    if (weight_[p] > 0) gap_[p] /= weight_[p];
    coverage_[p] = whole_[p] > 0 ? covered_[p] / whole_[p] : 0;
  }

  std::fill(locked_.begin(), locked_.end(), true);
  for (const Cell& cell : cells_) {
    std::int64_t at = cell.coupling;
    for (const std::int32_t owner : {contact_.slaves[cell.slave].cell, cell.master})
      for (const std::int32_t node : problem_.mesh.cells[owner])
        for (int d = 0; d < dimension; ++d, ++at)
          if (coupling_[at] != 0 && problem_.numbering.of(node, d) >= 0) locked_[contact_.slaves[cell.slave].patch] = false;
  }
}

void ContactState::integrate(const Zone& zone, const ContactCells& cells, std::span<const double> normals) {
  const Mesh& mesh = problem_.mesh;
  const int dimension = problem_.dimension, reference = dimension - 1;
  // one kernel call for each slave element (which says the kernel and the kind of cell) and kind of master cell
  const auto slave_cell_of = [&](std::int32_t c) { return contact_.slaves[zone.slaves[cells.slave[c]]].cell; };
  std::map<std::pair<std::int32_t, CellType>, std::vector<std::int32_t>> by_kinds;
  for (std::int32_t c = 0; c < static_cast<std::int32_t>(cells.size()); ++c)
    by_kinds[{problem_.model.element[slave_cell_of(c)], zone.master.types[cells.master[c]]}].push_back(c);

  for (const auto& [element_and_master, members] : by_kinds) {
    const std::int32_t first_cell = slave_cell_of(members.front());
    const std::pair kinds(mesh.types[first_cell], element_and_master.second);
    const int ns = catalog::cell(kinds.first).n_nodes, nm = catalog::cell(kinds.second).n_nodes;
    std::vector<std::int64_t> offset{0};
    std::vector<double> weight, slave_shape, slave_gradient, master_shape, slave_initial, slave, master, slave_normal;
    std::vector<double> shape(ns), gradient(static_cast<std::size_t>(ns) * reference), opposite(nm);
    for (const std::int32_t c : members) {
      for (std::int64_t p = cells.offset[c]; p < cells.offset[c + 1]; ++p) {
        const std::span<const double> xi(cells.slave_point.data() + p * reference, reference),
            eta(cells.master_point.data() + p * reference, reference);
        shape_functions(kinds.first, xi, shape);
        shape_gradients(kinds.first, xi, gradient);
        shape_functions(kinds.second, eta, opposite);
        slave_shape.insert(slave_shape.end(), shape.begin(), shape.end());
        slave_gradient.insert(slave_gradient.end(), gradient.begin(), gradient.end());
        master_shape.insert(master_shape.end(), opposite.begin(), opposite.end());
        weight.push_back(cells.weight[p]);
      }
      offset.push_back(static_cast<std::int64_t>(weight.size()));
      const std::int32_t slave_cell = slave_cell_of(c), master_cell = zone.masters[cells.master[c]];
      append_points(mesh, mesh.coordinates, slave_cell, dimension, slave_initial);
      append_points(mesh, coordinates_, slave_cell, dimension, slave);
      append_points(mesh, coordinates_, master_cell, dimension, master);
      if (!normals.empty()) append_points(mesh, normals, slave_cell, dimension, slave_normal);
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
      if (error[i] != LACON_FINE) refuse_slave(contact_.slaves[s].cell, error[i]);
      const std::int32_t patch = contact_.slaves[s].patch;
      gap_[patch] += gap[i];
      weight_[patch] += size[i];
      covered_[patch] += current[i];
      cells_.push_back({s, zone.masters[cells.master[c]], gap[i], static_cast<std::int64_t>(coupling_.size())});
      coupling_.insert(coupling_.end(), coupling.begin() + static_cast<std::ptrdiff_t>(i * width),
                       coupling.begin() + static_cast<std::ptrdiff_t>((i + 1) * width));
    }
  }
}

Patchwise ContactState::initial() const {
  Patchwise patches{std::vector<Status>(n_patches(), Status::unpaired), std::vector<double>(n_patches(), 0.0)};
  for (std::size_t p = 0; p < n_patches(); ++p) {
    if (zone_of_[p] < 0 || coverage_[p] <= tolerances_.unpaired) continue;
    const Zone& zone = zones_[zone_of_[p]];
    const bool touches = gap_[p] <= tolerances_.initial_gap * zone.smallest_edge && coverage_[p] >= tolerances_.least_coverage;
    const bool active = zone.initial_status == "OUI" || (zone.initial_status == "INTERPENETRE" && touches);
    patches.status[p] = active ? Status::active : Status::open;
  }
  return patches;
}

std::int64_t ContactState::update_statuses(Patchwise& patches) const {
  double largest = 0;
  for (const double lambda : patches.lambda) largest = std::max(largest, std::abs(lambda));
  std::int64_t changes = 0;
  for (std::size_t p = 0; p < n_patches(); ++p) {
    Status& status = patches.status[p];
    Status next = Status::unpaired;
    if (zone_of_[p] >= 0 && coverage_[p] > tolerances_.unpaired) {
      const double test = patches.lambda[p] + rho_[p] * gap_[p];
      const double round_off = tolerances_.lambda_round_off * largest + rho_[p] * gap_tolerance_;
      // inside the round-off of lambda and g a patch stays what it is: touching and unloaded, it must not flicker
      const bool was_active = status == Status::active;
      const bool active = (was_active ? test <= round_off : test < -round_off) && coverage_[p] >= tolerances_.least_coverage;
      next = active ? Status::active : Status::open;
    }
    changes += next != status;
    status = next;
  }
  return changes;
}

std::vector<Coupling> ContactState::couplings() const {
  std::vector<Coupling> couplings;
  const auto first_patch = static_cast<std::int32_t>(problem_.mesh.n_nodes());
  for (const Cell& cell : cells_)
    for (const std::int32_t owner : {contact_.slaves[cell.slave].cell, cell.master})
      for (const std::int32_t node : problem_.mesh.cells[owner])
        couplings.push_back({first_patch + contact_.slaves[cell.slave].patch, node});
  return couplings;
}

void ContactState::assemble(const Patchwise& patches, System& system) const {
  const Mesh& mesh = problem_.mesh;
  const int dimension = problem_.dimension;
  std::vector<bool> has_row(n_patches(), false);
  std::vector<std::int64_t> unknowns;
  std::vector<double> matrix, residual;
  for (const Cell& cell : cells_) {
    const SlaveElement& slave = contact_.slaves[cell.slave];
    const Status status = patches.status[slave.patch];
    if (status == Status::unpaired) continue;
    const catalog::SlaveRow* row = catalog::find_slave(mesh.patches->kind[slave.patch], slave.rank);
    const auto slave_nodes = mesh.cells[slave.cell], master_nodes = mesh.cells[cell.master];
    const ContactCellDofs dofs{.n_slave_nodes = static_cast<int>(slave_nodes.size()),
                               .n_master_nodes = static_cast<int>(master_nodes.size()),
                               .dimension = dimension,
                               .carriers = row->carriers};
    const std::size_t size = dofs.size();
    unknowns.resize(size);
    matrix.assign(size * (size + 1) / 2, 0.0);
    residual.assign(size, 0.0);
    for (int node = 0; node < dofs.n_slave_nodes + dofs.n_master_nodes; ++node) {
      const std::int64_t number = node < dofs.n_slave_nodes ? slave_nodes[node] : master_nodes[node - dofs.n_slave_nodes];
      for (int d = 0; d < dimension; ++d) unknowns[dofs.displacement(node, d)] = number * dimension + d;
    }
    // every carrier of the patch is its one equation: summing them up is the tying (METHOD.md 3.6)
    for (int c = 0; c < static_cast<int>(row->carriers.size()); ++c)
      unknowns[dofs.multiplier(c)] = system.multiplier(slave.patch);
    const std::span<const double> coupling(coupling_.data() + cell.coupling,
                                           static_cast<std::size_t>(dofs.n_slave_nodes + dofs.n_master_nodes) * dimension);
    contact_system(dofs, coupling, cell.gap, status == Status::active, patches.lambda[slave.patch], matrix, residual);
    // a locked patch has forces but no row
    if (status == Status::active && locked_[slave.patch]) std::fill(matrix.begin(), matrix.end(), 0.0);
    system.add(unknowns, matrix, residual);
    has_row[slave.patch] = true;
  }
  for (std::size_t p = 0; p < n_patches(); ++p) {
    const std::int64_t unknown = system.multiplier(static_cast<std::int64_t>(p));
    if (has_row[p] && !(patches.status[p] == Status::active && locked_[p])) continue;
    system.add_diagonal(unknown, 1.0);
    system.residual()[unknown] = has_row[p] ? 0.0 : patches.lambda[p];  // locked: lambda stays; unpaired: it goes to zero
  }
}

double ContactState::constraint_residual(const Patchwise& patches) const {
  double largest = 0;
  for (std::size_t p = 0; p < n_patches(); ++p)
    if (patches.status[p] == Status::active && !locked_[p]) largest = std::max(largest, std::abs(gap_[p]) / size_[p]);
  return largest;
}

std::int64_t ContactState::n_constraints(const Patchwise& patches) const {
  std::int64_t count = 0;
  for (std::size_t p = 0; p < n_patches(); ++p) count += patches.status[p] == Status::active && !locked_[p];
  return count;
}

std::vector<ZoneBalance> ContactState::balance(const Patchwise& patches) const {
  std::vector<ZoneBalance> zones;
  for (const ContactZone& zone : contact_.zones)
    zones.push_back({.slave_group = zone.slave_group, .master_group = zone.master_group});
  for (std::size_t p = 0; p < n_patches(); ++p) {
    if (zone_of_[p] < 0) continue;
    ZoneBalance& zone = zones[zone_of_[p]];
    zone.active += patches.status[p] == Status::active;
    zone.open += patches.status[p] == Status::open;
    zone.unpaired += patches.status[p] == Status::unpaired;
    zone.covered += covered_[p];
    zone.whole += whole_[p];
    zone.work = std::max(zone.work, std::abs(patches.lambda[p] * gap_[p]));
  }
  const int dimension = problem_.dimension;
  for (const Cell& cell : cells_) {
    const std::int32_t patch = contact_.slaves[cell.slave].patch;
    if (patches.status[patch] != Status::active) continue;
    ZoneBalance& zone = zones[zone_of_[patch]];
    std::int64_t at = cell.coupling;
    for (const bool slave : {true, false})
      for (const std::int32_t node : problem_.mesh.cells[slave ? contact_.slaves[cell.slave].cell : cell.master]) {
        std::array<double, 3> f{};  // the force on a node is -lambda C
        for (int d = 0; d < dimension; ++d) f[d] = -patches.lambda[patch] * coupling_[at++];
        const double* const x = coordinates_.data() + 3 * std::ptrdiff_t{node};
        for (int d = 0; d < 3; ++d) {
          (slave ? zone.on_slave : zone.on_master)[d] += f[d];
          zone.moment[d] += x[(d + 1) % 3] * f[(d + 2) % 3] - x[(d + 2) % 3] * f[(d + 1) % 3];
        }
      }
  }
  return zones;
}

}  // namespace lacon
