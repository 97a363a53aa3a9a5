#include "lacon/operators/contact/contact_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/pairing/normals.hpp"

namespace lacon {
namespace {

/// The patches around each node of the slave skins.
struct PatchesAround {
  std::vector<std::int32_t> nodes;  ///< by number
  Ragged<std::size_t> patches;      ///< of each node

  PatchesAround(const Mesh& mesh, const Contact& contact) {
    std::vector<std::pair<std::int32_t, std::size_t>> pairs;
    for (const SlaveElement& slave : contact.slaves)
      for (const std::int32_t node : mesh.cells[slave.cell]) pairs.emplace_back(node, slave.patch);
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    for (const auto& [node, patch] : pairs) {
      if (nodes.empty() || nodes.back() != node) {
        nodes.push_back(node);
        patches.offset.push_back(patches.offset.back());
      }
      patches.values.push_back(patch);
      ++patches.offset.back();
    }
  }
};

/// The mean of what `value` says of some patches, weighted with their measures.
template <class Value>
double mean(const ContactGeometry& geometry, std::span<const std::size_t> around, const Value& value) {
  double sum = 0, measure = 0;
  for (const std::size_t p : around) sum += geometry.whole(p) * value(p), measure += geometry.whole(p);
  return measure > 0 ? sum / measure : 0;
}

/// The pressure on a patch, over all of it: where little is covered the multiplier says how much that little carries.
double whole_pressure(std::size_t patch, const ContactGeometry& geometry, const Patchwise& patches) {
  return patches.status[patch] == Status::unpaired ? 0 : geometry.coverage(patch) * patches.lambda[patch];
}

constexpr double cancelled = 1e-6;  // what opposite unit normals may leave of their sum

/// Outward unit normals of all slave skins at the nodes, (n_nodes, 3), between those of the zones that meet there; zero
/// where these cancel, and elsewhere.
std::vector<double> slave_normals(const Mesh& mesh, const ContactGeometry& geometry) {
  std::vector<double> normals(3 * mesh.n_nodes(), 0.0);
  std::set<std::size_t> shared;  // nodes of several zones
  for (const ContactGeometry::Zone& zone : geometry.zones()) {
    const std::vector<double> own = nodal_normals(zone.slave);
    for (std::size_t node = 0; node < mesh.n_nodes(); ++node) {
      if (norm(vector_at(&own[3 * node])) > 0 && norm(vector_at(&normals[3 * node])) > 0) shared.insert(node);
      for (std::size_t i = 3 * node; i < 3 * node + 3; ++i) normals[i] += own[i];
    }
  }
  for (const std::size_t node : shared)
    for (const double length = norm(vector_at(&normals[3 * node])); double& component : std::span(&normals[3 * node], 3))
      component = length > cancelled ? component / length : 0;
  return normals;
}

/// Indices into Contact::slaves by ascending cell: the rows of CONT_ELEM.
std::vector<std::size_t> rows_of(const Contact& contact) {
  std::vector<std::size_t> rows(contact.slaves.size());
  std::iota(rows.begin(), rows.end(), 0);
  std::sort(rows.begin(), rows.end(),
            [&](std::size_t a, std::size_t b) { return contact.slaves[a].cell < contact.slaves[b].cell; });
  return rows;
}

/// The integral of the slave's normals over a contact cell, as long as its measure where it is flat.
double directed_measure(const Mesh& mesh, const Contact& contact, const ContactGeometry& geometry,
                        const ContactGeometry::Cell& cell) {
  const std::size_t nodes = mesh.cells[contact.slaves[cell.slave].cell].size(), dimension = mesh.dimension;
  std::array<double, 3> sum{};
  for (std::size_t i = 0; i < nodes * dimension; ++i) sum[i % dimension] += geometry.coupling()[cell.coupling + i];
  return std::hypot(sum[0], sum[1], sum[2]);
}

}  // namespace

PairedMasters paired_masters(const Mesh& mesh, const Contact& contact, const ContactGeometry& geometry) {
  std::vector<std::vector<std::pair<std::int32_t, double>>> seen(contact.slaves.size());
  std::vector<double> whole(geometry.n_patches(), 0.0);
  for (const ContactGeometry::Cell& cell : geometry.cells()) {
    const double measure = directed_measure(mesh, contact, geometry, cell);
    whole[contact.slaves[cell.slave].patch] += measure;
    seen[cell.slave].emplace_back(cell.master, measure);
  }
  PairedMasters masters;
  for (const std::size_t row : rows_of(contact)) {
    const std::size_t patch = contact.slaves[row].patch;
    std::sort(seen[row].begin(), seen[row].end());
    for (const auto& [cell, measure] : seen[row]) {
      if (std::cmp_equal(masters.cell.size(), masters.offset.back()) || masters.cell.back() != cell) {
        masters.cell.push_back(cell);
        masters.share.push_back(0);
      }
      // on the axis of revolution couples have no measure
      if (whole[patch] > 0) masters.share.back() += geometry.coverage(patch) * measure / whole[patch];
    }
    masters.offset.push_back(static_cast<std::int64_t>(masters.cell.size()));
  }
  return masters;
}

Field contact_field(const Contact& contact, const ContactGeometry& geometry, const Patchwise& patches) {
  Field field{.name = "CONT_ELEM", .quantity = "CLAC_R", .location = Location::cells, .components = {"CONT"}};
  for (const PatchQuantity& quantity : patch_quantities) field.components.emplace_back(quantity.component);
  field.components.insert(field.components.end(), {"JEU", "COEFSURF", "PRESCOOR"});
  for (const std::size_t row : rows_of(contact)) {
    const SlaveElement& slave = contact.slaves[row];
    const std::size_t p = slave.patch;
    const bool paired = patches.status[p] != Status::unpaired;
    field.support.push_back(slave.cell);
    field.values.push_back(static_cast<double>(patches.status[p]));
    for (const PatchQuantity& quantity : patch_quantities) field.values.push_back(paired ? (patches.*quantity.values)[p] : 0);
    field.values.insert(field.values.end(), {paired ? geometry.gap(p) : Field::no_value, paired ? geometry.coverage(p) : 0,
                                             whole_pressure(p, geometry, patches)});
    for (const std::string& component : field.components)  // JEU is -1 where there is no gap
      field.present.push_back(paired || component != "JEU" ? Field::there : Field::marker);
  }
  if (std::count(field.present.begin(), field.present.end(), Field::marker) == 0) field.present.clear();
  return field;
}

std::vector<std::pair<std::int32_t, double>> nodal_pressures(const Mesh& mesh, const Contact& contact,
                                                             const ContactGeometry& geometry, const Patchwise& patches) {
  const PatchesAround around(mesh, contact);
  std::vector<std::pair<std::int32_t, double>> pressures;
  for (std::size_t i = 0; i < around.nodes.size(); ++i)
    pressures.emplace_back(around.nodes[i], mean(geometry, around.patches[i],
                                                 [&](std::size_t p) { return whole_pressure(p, geometry, patches); }));
  return pressures;
}

Field nodal_contact_field(const Mesh& mesh, const Contact& contact, const ContactState& state, const Patchwise& patches) {
  Field field{.name = "CONT_NOEU", .quantity = "INFC_R", .location = Location::nodes, .components = {"CONT", "JEU", "PRES"}};
  const int dimension = mesh.dimension;
  for (const char* vector : {"RN", "R", "V"}) {
    if (*vector == 'R') field.components.emplace_back(vector);
    for (int d = 0; d < dimension; ++d) field.components.push_back(std::string(vector) + "XYZ"[d]);
  }
  const ContactGeometry& geometry = state.geometry();
  const std::vector<double> forces = state.forces(patches), normals = slave_normals(mesh, geometry);
  const PatchesAround around(mesh, contact);
  field.support = around.nodes;
  for (std::size_t i = 0; i < around.nodes.size(); ++i) {
    const std::span<const std::size_t> all = around.patches[i];
    std::vector<std::size_t> paired;
    for (const std::size_t p : all)
      if (patches.status[p] != Status::unpaired) paired.push_back(p);
    const bool active = std::ranges::any_of(all, [&](std::size_t p) { return patches.status[p] == Status::active; });
    field.values.push_back(active ? 2.0 : paired.empty() ? -1.0 : 0.0);
    field.values.push_back(paired.empty() ? Field::no_value
                                          : mean(geometry, paired, [&](std::size_t p) { return geometry.gap(p); }));
    field.values.push_back(mean(geometry, all, [&](std::size_t p) { return whole_pressure(p, geometry, patches); }));
    const std::size_t node = static_cast<std::size_t>(around.nodes[i]);
    const std::span<const double> force(forces.data() + node * dimension, dimension);
    double square = 0;
    for (const double f : force) square += f * f;
    for (int with_friction = 0; with_friction < 2; ++with_friction) {
      field.values.push_back(std::sqrt(square));
      field.values.insert(field.values.end(), force.begin(), force.end());
    }
    field.values.insert(field.values.end(), normals.begin() + 3 * node, normals.begin() + 3 * node + dimension);
    for (const std::string& component : field.components)
      field.present.push_back(component == "JEU" && paired.empty() ? Field::marker : Field::there);
  }
  if (std::count(field.present.begin(), field.present.end(), Field::marker) == 0) field.present.clear();
  return field;
}

Patchwise patches_of(const Field& field, const Mesh& mesh, const Contact& contact, const std::string& label) {
  const auto refuse = [&](std::int32_t cell, const std::string& lack) {
    fail("EVOLUTION_11", {{"label", label}, {"field", field.name}, {"cell", cell_name(cell)}, {"lack", lack}});
  };
  std::vector<std::int32_t> row(mesh.n_cells(), -1);
  for (std::size_t i = 0; i < field.support.size(); ++i) row[field.support[i]] = static_cast<std::int32_t>(i);
  const auto value = [&](std::int32_t cell, const char* name) {
    const int component = field.component(name);
    if (row[cell] < 0) refuse(cell, part("no_values_there"));
    if (component < 0 || !field.has(row[cell], component))
      refuse(cell, part("no_component_there", {{"component", name}, {"needed", "CONT, PRES"}}));
    return field.at(row[cell], component);
  };
  Patchwise patches(mesh.patches->size());
  for (const SlaveElement& slave : contact.slaves) {
    patches.status[slave.patch] = static_cast<Status>(std::lround(value(slave.cell, "CONT")));
    for (const PatchQuantity& quantity : patch_quantities)
      (patches.*quantity.values)[slave.patch] = value(slave.cell, quantity.component);
  }
  return patches;
}

}  // namespace lacon
