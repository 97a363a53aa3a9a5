#include "lacon/operators/contact/contact_field.hpp"

#include <algorithm>
#include <cmath>

#include "lacon/catalog/messages.hpp"

namespace lacon {

Field contact_field(const Contact& contact, const ContactGeometry& geometry, const Patchwise& patches) {
  Field field{.name = "CONT_ELEM", .quantity = "CLAC_R", .location = Location::cells, .components = {"CONT"}};
  for (const PatchQuantity& quantity : patch_quantities) field.components.emplace_back(quantity.component);
  field.components.insert(field.components.end(), {"JEU", "COEFSURF", "PRESCOOR"});
  std::vector<SlaveElement> slaves = contact.slaves;
  std::sort(slaves.begin(), slaves.end(), [](const SlaveElement& a, const SlaveElement& b) { return a.cell < b.cell; });
  for (const SlaveElement& slave : slaves) {
    const std::size_t p = slave.patch;
    const bool paired = patches.status[p] != Status::unpaired;
    field.support.push_back(slave.cell);
    field.values.push_back(static_cast<double>(patches.status[p]));
    for (const PatchQuantity& quantity : patch_quantities) field.values.push_back(paired ? (patches.*quantity.values)[p] : 0);
    const double pressure = paired ? patches.lambda[p] : 0, coverage = paired ? geometry.coverage(p) : 0;
    field.values.insert(field.values.end(), {paired ? geometry.gap(p) : -1.0, coverage, coverage * pressure});
    for (const std::string& component : field.components)  // JEU is -1 where there is no gap
      field.present.push_back(paired || component != "JEU" ? Field::there : Field::stand_in);
  }
  if (std::count(field.present.begin(), field.present.end(), Field::stand_in) == 0) field.present.clear();
  return field;
}

Patchwise patches_of(const Field& field, const Mesh& mesh, const Contact& contact, const std::string& label) {
  const auto refuse = [&](std::int32_t cell) {
    fail("EVOLUTION_11", {{"label", label}, {"field", field.name}, {"cell", cell_name(cell)}});
  };
  std::vector<std::int32_t> row(mesh.n_cells(), -1);
  for (std::size_t i = 0; i < field.support.size(); ++i) row[field.support[i]] = static_cast<std::int32_t>(i);
  const auto value = [&](std::int32_t cell, const char* name) {
    const int component = field.component(name);
    if (row[cell] < 0 || component < 0 || !field.has(row[cell], component)) refuse(cell);
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
