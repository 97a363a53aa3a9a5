#include "lacon/operators/contact/contact_state.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "lacon/catalog/contact.hpp"
#include "lacon/catalog/messages.hpp"
#include "lacon/elements/contact_system.hpp"
#include "lacon/operators/contact/contact_edge.hpp"
#include "lacon/operators/contact/facing.hpp"
#include "lacon/operators/meshing/body.hpp"
#include "lacon/pairing/normals.hpp"

namespace lacon {
namespace {

/// Nodes of each patch, without those that carry its pressure. @param slaves of one zone
std::vector<std::vector<std::int32_t>> corners_of(const Mesh& mesh, const Contact& contact,
                                                  const std::vector<std::int32_t>& slaves) {
  std::vector<std::set<std::int32_t>> nodes(mesh.patches->size());
  for (const std::int32_t number : slaves) {
    const SlaveElement& slave = contact.slaves[number];
    const catalog::SlaveRow* row = catalog::find_slave(mesh.patches->kind[slave.patch], slave.rank);
    for (std::int8_t i = 0; const std::int32_t node : mesh.cells[slave.cell])
      if (std::ranges::find(row->carriers, i++) == row->carriers.end()) nodes[slave.patch].insert(node);
  }
  std::vector<std::vector<std::int32_t>> corners;
  for (const std::set<std::int32_t>& of_patch : nodes) corners.emplace_back(of_patch.begin(), of_patch.end());
  return corners;
}

}  // namespace

ContactState::ContactState(const Mesh& mesh, const Model& model, const Contact& contact, Registry& registry,
                           ContactBodies bodies)
    : mesh_(mesh), contact_(contact), geometry_(mesh, model, contact, registry), free_(std::move(bodies.free)) {
  geometry_.find_ends(bodies.held);
  own_ = rho_ = std::vector<double>(n_patches(), 0.0);
  flexibility_.assign(mesh.n_cells(), 0.0);
  locked_.assign(n_patches(), false);
  held_open_ = gliding_ = keeps_cover_ = locked_;
  for (const ContactZone& zone : contact.zones)
    for (const std::int32_t patch : zone.held_open) held_open_[patch] = true;
  for (const ContactGeometry::Zone& zone : geometry_.zones())
    smallest_edge_.push_back(std::min(smallest_edge(zone.slave), smallest_edge(zone.master)));

  const NodeCells around(mesh);
  const auto modulus_below = [&](std::int32_t cell) {
    std::optional<double> modulus;
    for (const BodyCell& body : body_cells(mesh, around, cell))
      if (const auto own = bodies.modulus(body.cell)) modulus = own;
    return modulus;
  };
  for (const SlaveElement& slave : contact_.slaves) {
    // the first sub-cell's body stands for the patch: all its sub-cells come from one body cell
    if (slave.rank > 0) continue;
    const std::optional<double> modulus = modulus_below(slave.cell);
    if (!modulus) fail("EVOLUTION_2", {{"cell", cell_name(slave.cell)}});
    own_[slave.patch] = 1 / *modulus;
  }
  for (const ContactZone& zone : contact_.zones)
    for (const std::int32_t cell : zone.master)
      if (const std::optional<double> modulus = modulus_below(cell)) flexibility_[cell] = 1 / *modulus;
  std::map<std::pair<std::int32_t, std::int32_t>, std::set<std::int32_t>> around_node;  // patches of a zone
  for (const SlaveElement& slave : contact_.slaves)
    for (const std::int32_t node : mesh.cells[slave.cell])
      around_node[{geometry_.zone_of(slave.patch), node}].insert(slave.patch);
  std::vector<std::set<std::int32_t>> neighbours(n_patches());
  for (const auto& [where, patches] : around_node)
    for (const std::int32_t patch : patches) neighbours[patch].insert(patches.begin(), patches.end());
  for (std::size_t p = 0; p < n_patches(); ++p) {
    neighbours[p].erase(static_cast<std::int32_t>(p));
    neighbours_.emplace_back(neighbours[p].begin(), neighbours[p].end());
  }
  for (std::size_t zone = 0; zone < geometry_.zones().size(); ++zone) {
    const auto corners = corners_of(mesh, contact, geometry_.zones()[zone].slaves);
    alternations_.emplace_back(corners);
    std::vector<Vec3> normals(corners.size());
    for (const std::int32_t slave : geometry_.zones()[zone].slaves)
      normals[contact.slaves[slave].patch] = facing(mesh, contact.slaves[slave].cell, mesh.coordinates).normal;
    rows_.emplace_back(corners, normals, mesh.dimension - 1);
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

void ContactState::update_geometry(std::span<const double> displacement) {
  geometry_.update(displacement);
  note_geometry();
}

bool ContactState::choose_masters() {
  if (!geometry_.choose_masters()) return false;
  note_geometry();
  return true;
}

bool ContactState::go_on_where_flush() {
  if (!geometry_.go_on_where_flush()) return false;
  note_geometry();
  return true;
}

void ContactState::note_geometry() {
  variations_.clear();
  std::fill(locked_.begin(), locked_.end(), true);
  std::vector<double> softest(n_patches(), 0.0);  // 1 / E of the softest body that a patch faces
  for (const ContactGeometry::Cell& cell : geometry_.cells()) {
    double& master = softest[contact_.slaves[cell.slave].patch];
    master = std::max(master, flexibility_[cell.master]);
    std::int64_t at = cell.coupling;
    for (const std::int32_t owner : {contact_.slaves[cell.slave].cell, cell.master})
      for (const std::int32_t node : mesh_.cells[owner])
        for (int d = 0; d < mesh_.dimension; ++d, ++at)
          if (geometry_.coupling()[at] != 0 && free_[static_cast<std::size_t>(node) * mesh_.dimension + d])
            locked_[contact_.slaves[cell.slave].patch] = false;
  }
  // a pressure on a patch of size h moves either body by about h / E: if rho were that of the stiffer one alone, the error of a
  // gap by its linearisation would hide any pressure, and statuses alternate
  for (std::size_t p = 0; p < n_patches(); ++p) rho_[p] = 1 / (size_[p] * (own_[p] + softest[p]));
}

Patchwise ContactState::initial() const {
  Patchwise patches(n_patches());
  // what is far from its master does not close at once, unless a whole zone is
  const auto is_near = [&](std::size_t p) { return geometry_.gap(p) <= tolerances_.starting_gap * size_[p]; };
  std::vector<bool> comes_near(contact_.zones.size(), false);
  for (std::size_t p = 0; p < n_patches(); ++p)
    if (geometry_.zone_of(p) >= 0 && takes_contact(p) && is_near(p))
      comes_near[static_cast<std::size_t>(geometry_.zone_of(p))] = true;
  for (std::size_t p = 0; p < n_patches(); ++p) {
    if (geometry_.zone_of(p) < 0 || geometry_.coverage(p) <= tolerances_.unpaired) continue;
    const std::int32_t zone = geometry_.zone_of(p);
    const std::string& asked = contact_.zones[zone].initial_status;
    const bool touches = geometry_.gap(p) <= tolerances_.initial_gap * smallest_edge_[zone] && takes_contact(p);
    const bool starts = asked == "OUI" && (is_near(p) || !comes_near[static_cast<std::size_t>(zone)]);
    const bool active = !held_open_[p] && (starts || (asked == "INTERPENETRE" && touches));
    patches.status[p] = active ? Status::active : Status::open;
  }
  return patches;
}

void ContactState::keep_gliding(const Patchwise& patches) {
  for (std::size_t p = 0; p < n_patches(); ++p)
    gliding_[p] = geometry_.zone_of(p) >= 0 && contact_.zones[geometry_.zone_of(p)].gliding == "OUI" &&
                  patches.status[p] == Status::active;
}

void ContactState::let_covers_go() {
  for (std::size_t p = 0; p < n_patches(); ++p)
    if (!is_covered_in_part(p)) keeps_cover_[p] = false;
}

std::int64_t ContactState::update_statuses(Patchwise& patches) const {
  double largest = 0;
  for (const double lambda : patches.lambda) largest = std::max(largest, std::abs(lambda));
  std::int64_t changes = 0;
  for (std::size_t p = 0; p < n_patches(); ++p) {
    Status& status = patches.status[p];
    Status next = Status::unpaired;
    if (geometry_.zone_of(p) >= 0 && geometry_.coverage(p) > tolerances_.unpaired) {
      const double test = patches.lambda[p] + rho_[p] * geometry_.gap(p);
      const double round_off = tolerances_.lambda_round_off * largest + rho_[p] * gap_tolerance_;
      // inside the round-off of lambda and g a patch stays what it is: touching and unloaded, it must not flicker
      const bool was_active = status == Status::active;
      const bool pressed = was_active ? test <= round_off : test < -round_off;
      const bool covered = was_active ? is_covered(p) : takes_contact(p);
      const bool active = (pressed || gliding_[p]) && covered && !held_open_[p];
      next = active ? Status::active : Status::open;
    }
    changes += next != status;
    status = next;
  }
  return changes;
}

std::int64_t ContactState::open_behind_edges(const std::vector<Status>& before, Patchwise& patches, EdgeCourse* course) const {
  std::vector<double> force(n_patches(), 0.0);
  std::vector<bool> pulled(n_patches(), false), pressed(n_patches(), false);
  for (std::size_t p = 0; p < n_patches(); ++p) {
    if (before[p] != Status::active || locked_[p]) continue;
    force[p] = patches.lambda[p] * geometry_.covered(p);
    pulled[p] = patches.status[p] == Status::open && force[p] > 0;
    pressed[p] = patches.status[p] == Status::active && force[p] < 0 && !gliding_[p];
  }
  const std::vector<std::size_t> opened = behind_the_edge(neighbours_, force, pulled, pressed, course);
  for (const std::size_t patch : opened) patches.status[patch] = Status::open;
  return static_cast<std::int64_t>(opened.size());
}

void ContactState::linearise(const Patchwise& patches, bool second) {
  second_ = second && !contact_.frozen_gap;
  std::vector<std::int8_t> order(n_patches(), 0);
  for (std::size_t p = 0; p < n_patches(); ++p)
    if (patches.status[p] == Status::active) order[p] = second_ && patches.lambda[p] != 0 ? 2 : 1;
  variations_ = geometry_.vary(order, keeps_cover_);
}

std::vector<std::pair<std::int64_t, std::int64_t>> ContactState::coupled_vertices() const {
  std::vector<std::pair<std::int64_t, std::int64_t>> couples;
  const auto first_patch = static_cast<std::int64_t>(mesh_.n_nodes());
  for (const ContactGeometry::Cell& cell : geometry_.cells())
    for (const std::int32_t owner : {contact_.slaves[cell.slave].cell, cell.master})
      for (const std::int32_t node : mesh_.cells[owner])
        couples.emplace_back(first_patch + contact_.slaves[cell.slave].patch, node);
  for (const ContactGeometry::Variation& variation : variations_) {
    const std::vector<std::int32_t>& nodes = variation.nodes;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      couples.emplace_back(first_patch + contact_.slaves[variation.slave].patch, nodes[i]);
      for (std::size_t j = 0; second_ && j < i; ++j)
        if (nodes[i] != nodes[j]) couples.emplace_back(nodes[i], nodes[j]);
    }
  }
  return couples;
}

void ContactState::evaluate(const Patchwise& patches, const std::function<void(const ContactTerm&)>& use) const {
  const int dimension = mesh_.dimension;
  const auto first_patch = static_cast<std::int64_t>(mesh_.n_nodes());
  std::vector<bool> has_row(n_patches(), false), keeps_multiplier(n_patches(), false);
  std::vector<ContactUnknown> unknowns;
  std::vector<double> matrix, residual;
  for (const ContactGeometry::Variation& variation : variations_) {
    const SlaveElement& slave = contact_.slaves[variation.slave];
    const catalog::SlaveRow* row = catalog::find_slave(mesh_.patches->kind[slave.patch], slave.rank);
    const std::vector<std::int32_t>& nodes = variation.nodes;
    const int n_slave_nodes = static_cast<int>(mesh_.cells[slave.cell].size());
    const ContactCellDofs dofs{.n_slave_nodes = n_slave_nodes,
                               .n_master_nodes = static_cast<int>(nodes.size()) - n_slave_nodes,
                               .dimension = dimension,
                               .carriers = row->carriers};
    const std::size_t size = dofs.size();
    unknowns.resize(size);
    matrix.assign(size * (size + 1) / 2, 0.0);
    residual.assign(size, 0.0);
    for (int node = 0; node < static_cast<int>(nodes.size()); ++node)
      for (int d = 0; d < dimension; ++d) unknowns[dofs.displacement(node, d)] = {nodes[node], d};
    // every carrier of the patch is its one equation: summing them up is the tying (METHOD.md 3.6)
    for (int l = 0; l < static_cast<int>(row->carriers.size()); ++l)
      unknowns[dofs.multiplier(l)] = {first_patch + slave.patch, 0};
    const GapVariation& of_gap = variation.of_gap;
    contact_system(dofs, of_gap.gradient, of_gap.hessian, of_gap.gap, true, patches.lambda[slave.patch], matrix, residual);
    // a locked patch has forces but no row
    if (locked_[slave.patch]) {
      std::fill(matrix.begin(), matrix.end(), 0.0);
      for (int l = 0; l < static_cast<int>(row->carriers.size()); ++l) residual[dofs.multiplier(l)] = 0;
      keeps_multiplier[slave.patch] = true;
    } else {
      has_row[slave.patch] = true;
    }
    use({unknowns, matrix, residual});
  }
  // the multiplier of a patch without contact goes to zero
  constexpr double one = 1;
  for (std::size_t p = 0; p < n_patches(); ++p) {
    if (has_row[p]) continue;
    const ContactUnknown unknown{first_patch + static_cast<std::int64_t>(p), 0};
    const double left = keeps_multiplier[p] ? 0 : patches.lambda[p];
    use({{&unknown, 1}, {&one, 1}, {&left, 1}});
  }
}

double ContactState::constraint_residual(const Patchwise& patches) const {
  // of the rows: polygons that are differentiated follow curves by other pieces than those that are only measured
  std::vector<double> integral(n_patches(), 0.0);
  for (const ContactGeometry::Variation& variation : variations_)
    integral[contact_.slaves[variation.slave].patch] += variation.of_gap.gap;
  double largest = 0;
  for (std::size_t p = 0; p < n_patches(); ++p)
    if (patches.status[p] == Status::active && !locked_[p] && geometry_.covered(p) > 0)
      largest = std::max(largest, std::abs(integral[p]) / (geometry_.covered(p) * size_[p]));
  return largest;
}

std::vector<double> ContactState::gaps_over_size() const {
  std::vector<double> gaps(n_patches(), 0.0);
  for (std::size_t p = 0; p < n_patches(); ++p)
    if (takes_contact(p)) gaps[p] = geometry_.gap(p) / size_[p];
  return gaps;
}

bool ContactState::presses_otherwise(std::span<const double> gaps, std::span<const double> covered,
                                     const Patchwise& patches) const {
  for (std::size_t p = 0; p < n_patches(); ++p)
    if (patches.status[p] == Status::active && (geometry_.gap(p) != gaps[p] || geometry_.covered(p) != covered[p])) return true;
  Patchwise now = patches;
  return update_statuses(now) > 0;
}

bool ContactState::closes_within(int increments, std::span<const double> before) const {
  const std::vector<double> now = gaps_over_size();
  for (std::size_t p = 0; p < n_patches(); ++p)
    if (now[p] > 0 && increments * (before[p] - now[p]) >= now[p]) return true;
  return false;
}

double ContactState::part_to_depth(const Patchwise& patches, std::span<const double> before, double limit, double depth) const {
  const std::vector<double> now = gaps_over_size();
  double part = 1;
  for (std::size_t p = 0; p < n_patches(); ++p)
    if (patches.status[p] == Status::open && !held_open_[p] && now[p] < -limit && before[p] > -depth)
      part = std::min(part, (before[p] + depth) / (before[p] - now[p]));
  return part;
}

std::int64_t ContactState::n_constraints(const Patchwise& patches) const {
  std::int64_t count = 0;
  for (std::size_t p = 0; p < n_patches(); ++p) count += patches.status[p] == Status::active && !locked_[p];
  return count;
}

HeldOverlap ContactState::held_overlap() const {
  HeldOverlap overlap;
  for (std::size_t p = 0; p < n_patches(); ++p) {
    if (!locked_[p] || held_open_[p] || !is_covered(p) || geometry_.gap(p) >= -tolerances_.held_overlap * size_[p]) continue;
    ++overlap.count;
    if (geometry_.gap(p) < overlap.gap) overlap.deepest = p, overlap.gap = geometry_.gap(p);
  }
  return overlap;
}

std::optional<AlternatingPressures> ContactState::alternation(std::int32_t zone, const Patchwise& patches,
                                                              const std::function<bool()>& has_facets) const {
  constexpr double whole = 0.99;
  std::vector<bool> seen(n_patches()), pressed(n_patches()), resisting(n_patches());
  std::vector<double> area(n_patches());
  for (std::size_t p = 0; p < n_patches(); ++p) {
    seen[p] = !locked_[p] && geometry_.coverage(p) > whole;
    pressed[p] = seen[p] && patches.status[p] == Status::active;
    resisting[p] = seen[p] && resists_its_master(p);
    area[p] = geometry_.whole(p);
  }
  const auto of_zone = static_cast<std::size_t>(zone);
  const auto much = [&](const std::optional<AlternatingPressures>& found) {
    return found && found->share > tolerances_.alternating ? found : std::nullopt;
  };
  if (const auto found = much(alternations_[of_zone].measure(patches.lambda, area, pressed, pressed))) return found;
  if (auto all = alternations_[of_zone].measure(patches.lambda, area, seen, pressed)) {
    if (all->share > tolerances_.scattered && all->pressing < tolerances_.few) {
      all->by = AlternatingBy::few_patches;
      return all;
    }
    if (all->scatter > tolerances_.scatter && has_facets()) {
      all->by = AlternatingBy::scattered;
      all->share = all->scatter;
      return all;
    }
  }
  const auto everywhere = much(rows_[of_zone].measure(patches.lambda, area, seen, pressed));
  const auto inside = much(rows_[of_zone].measure_inside(patches.lambda, area, seen, pressed, resisting));
  if (!everywhere && !inside) return std::nullopt;
  return has_facets() ? everywhere : inside;
}

bool ContactState::presses(std::int32_t zone, const Patchwise& patches) const {
  for (std::size_t p = 0; p < n_patches(); ++p)
    if (geometry_.zone_of(p) == zone && patches.status[p] == Status::active) return true;
  return false;
}

std::optional<double> ContactState::undecided(std::int32_t zone, const Patchwise& patches) const {
  double largest = 0, round_off = 0;
  for (std::size_t p = 0; p < n_patches(); ++p) {
    if (geometry_.zone_of(p) != zone || patches.status[p] != Status::active) continue;
    largest = std::max(largest, std::abs(patches.lambda[p]));
    round_off = std::max(round_off, rho_[p] * gap_tolerance_);
  }
  return largest > 0 ? std::optional(round_off / largest) : std::nullopt;
}

double ContactState::largest_strain(std::int32_t zone, const Patchwise& patches) const {
  double largest = 0;
  for (std::size_t p = 0; p < n_patches(); ++p)
    if (geometry_.zone_of(p) == zone && patches.status[p] == Status::active) largest = std::max(largest, strain(p, patches));
  return largest;
}

namespace {

/// Call use(node, slave or not, force) for each node that a contact cell pushes; the force on a body is -lambda dG/du.
template <class Use>
void for_each_force(const ContactGeometry::Variation& variation, int dimension, double lambda, Use use) {
  for (std::size_t i = 0; i < variation.nodes.size(); ++i) {
    const double* const gradient = variation.of_gap.gradient.data() + i * static_cast<std::size_t>(dimension);
    const Vec3 of_node = {gradient[0], gradient[1], dimension == 3 ? gradient[2] : 0};
    use(variation.nodes[i], static_cast<int>(i) < variation.n_slave_nodes, -lambda * of_node);
  }
}

}  // namespace

std::vector<double> ContactState::forces(const Patchwise& patches) const {
  std::vector<double> sum(free_.size(), 0.0);
  const int dimension = mesh_.dimension;
  for (const ContactGeometry::Variation& variation : variations_)
    for_each_force(variation, dimension, patches.lambda[contact_.slaves[variation.slave].patch],
                   [&](std::int32_t node, bool, Vec3 force) {
                     for (int d = 0; d < dimension; ++d)
                       sum[static_cast<std::size_t>(node) * dimension + d] += component(force, d);
                   });
  return sum;
}

std::vector<ZoneBalance> ContactState::balance(const Patchwise& patches) const {
  std::vector<ZoneBalance> zones;
  for (const ContactZone& zone : contact_.zones)
    zones.push_back({.slave_group = zone.slave_group, .master_group = zone.master_group});
  for (std::size_t p = 0; p < n_patches(); ++p) {
    if (geometry_.zone_of(p) < 0) continue;
    ZoneBalance& zone = zones[geometry_.zone_of(p)];
    zone.active += patches.status[p] == Status::active;
    zone.open += patches.status[p] == Status::open;
    zone.unpaired += patches.status[p] == Status::unpaired;
    zone.covered += geometry_.covered(p);
    zone.whole += geometry_.whole(p);
    zone.work = std::max(zone.work, std::abs(patches.lambda[p] * geometry_.gap(p)));
  }
  for (const ContactGeometry::Variation& variation : variations_) {
    const std::int32_t patch = contact_.slaves[variation.slave].patch;
    ZoneBalance& zone = zones[geometry_.zone_of(patch)];
    for_each_force(variation, mesh_.dimension, patches.lambda[patch], [&](std::int32_t node, bool slave, Vec3 force) {
      Vec3& resultant = slave ? zone.on_slave : zone.on_master;
      resultant = resultant + force;
      const Vec3 lever = vector_at(geometry_.coordinates().data() + 3 * std::ptrdiff_t{node});
      zone.moment = zone.moment + cross(lever, force);
    });
  }
  return zones;
}

}  // namespace lacon
