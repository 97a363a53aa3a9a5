#include "lacon/structures/storage/storage.hpp"

#include <utility>

#include "lacon/catalog/wording.hpp"
#include "lacon/structures/storage/pieces.hpp"

namespace lacon::storage {
namespace {

/// The zone's members that are plain texts, by the name of their dataset.
const std::pair<const char*, std::string ContactZone::*> zone_texts[] = {{"zones/slave_group", &ContactZone::slave_group},
                                                                         {"zones/master_group", &ContactZone::master_group},
                                                                         {"zones/jacobian", &ContactZone::jacobian},
                                                                         {"zones/search", &ContactZone::search},
                                                                         {"zones/initial_status", &ContactZone::initial_status},
                                                                         {"zones/resolution", &ContactZone::resolution},
                                                                         {"zones/gliding", &ContactZone::gliding}};

/// The zone's members that are a number.
const std::pair<const char*, double ContactZone::*> zone_numbers[] = {
    {"zones/tolerance", &ContactZone::tolerance},
    {"zones/distance_limit", &ContactZone::distance_limit},
    {"zones/overlap_tolerance", &ContactZone::overlap_tolerance}};

/// The zone's members that are lists of numbers.
const std::pair<const char*, std::vector<std::int32_t> ContactZone::*> zone_lists[] = {
    {"zones/slave", &ContactZone::slave},
    {"zones/master", &ContactZone::master},
    {"zones/patches", &ContactZone::patches},
    {"zones/held_open", &ContactZone::held_open}};

/// The zone's members that are numbers or functions.
const std::pair<const char*, LoadValue ContactZone::*> zone_values[] = {{"zones/slave_offset", &ContactZone::slave_offset},
                                                                        {"zones/master_offset", &ContactZone::master_offset}};

}  // namespace

Contact read_contact(const hdf5::Group& root) {
  Contact contact;
  contact.model = root.text("model");
  contact.mesh = root.text("mesh");
  contact.algorithm = root.text("algorithm");
  contact.smoothing = root.integer("smoothing") != 0;
  contact.frozen_gap = root.has_attribute("frozen_gap") && root.integer("frozen_gap") != 0;  // a base may be older
  contact.verify_normals = root.integer("verify_normals") != 0;
  contact.resi_geom = root.real("resi_geom");
  contact.stops_at_overlap = root.has_attribute("stops_at_overlap") && root.integer("stops_at_overlap") != 0;
  if (root.has_attribute("elastic_iterations")) contact.elastic_iterations = root.integer("elastic_iterations");
  contact.zones.resize(root.read<double>("zones/tolerance").size());
  for (const auto& [name, member] : zone_numbers) {
    if (!root.has(name)) continue;  // a base older than the number
    const auto values = root.read<double>(name);
    for (std::size_t z = 0; z < contact.zones.size(); ++z) contact.zones[z].*member = values.at(z);
  }
  for (const auto& [name, member] : zone_texts) {
    if (!root.has(name)) continue;
    const auto values = root.read_strings(name);
    for (std::size_t z = 0; z < contact.zones.size(); ++z) contact.zones[z].*member = values.at(z);
  }
  for (const auto& [name, member] : zone_lists) {
    if (!root.has(name)) continue;
    const auto values = read_ragged<std::int32_t>(root, name);
    if (values.size() != contact.zones.size())
      refuse(root, part("does_not_fit", {{"what", name}, {"other", "zones/tolerance"}}));
    for (std::size_t z = 0; z < contact.zones.size(); ++z)
      (contact.zones[z].*member).assign(values[z].begin(), values[z].end());
  }
  for (const auto& [name, member] : zone_values) {
    if (!root.has(name)) continue;
    const std::vector<LoadValue> values = read_load_values(root.open(name));
    for (std::size_t z = 0; z < contact.zones.size(); ++z) contact.zones[z].*member = values.at(z);
  }
  const hdf5::Group slave = root.open("slave");
  const auto cell = slave.read<std::int32_t>("cell"), patch = slave.read<std::int32_t>("patch"),
             rank = slave.read<std::int32_t>("rank");
  const auto element = slave.read_strings("element");
  for (std::size_t i = 0; i < cell.size(); ++i) contact.slaves.push_back({cell[i], patch.at(i), rank.at(i), element.at(i)});
  if (!root.has("skin")) return contact;
  const hdf5::Group skin = root.open("skin");
  const auto skin_cell = skin.read<std::int32_t>("cell");
  const auto skin_element = skin.read_strings("element");
  for (std::size_t i = 0; i < skin_cell.size(); ++i) contact.skins.push_back({skin_cell[i], skin_element.at(i)});
  return contact;
}

void write(const hdf5::Group& root, const Contact& contact) {
  root.set("model", contact.model);
  root.set("mesh", contact.mesh);
  root.set("algorithm", contact.algorithm);
  root.set("smoothing", std::int64_t{contact.smoothing});
  root.set("frozen_gap", std::int64_t{contact.frozen_gap});
  root.set("verify_normals", std::int64_t{contact.verify_normals});
  root.set("resi_geom", contact.resi_geom);
  root.set("elastic_iterations", contact.elastic_iterations);
  root.set("stops_at_overlap", std::int64_t{contact.stops_at_overlap});
  for (const auto& [name, member] : zone_numbers) {
    std::vector<double> values;
    for (const ContactZone& zone : contact.zones) values.push_back(zone.*member);
    root.write(name, values);
  }
  for (const auto& [name, member] : zone_texts) {
    std::vector<std::string> values;
    for (const ContactZone& zone : contact.zones) values.push_back(zone.*member);
    root.write_strings(name, values);
  }
  for (const auto& [name, member] : zone_lists) {
    Ragged<std::int32_t> values;
    for (const ContactZone& zone : contact.zones) values.push_back(zone.*member);
    write_ragged(root, name, values);
  }
  for (const auto& [name, member] : zone_values) {
    std::vector<LoadValue> values;
    for (const ContactZone& zone : contact.zones) values.push_back(zone.*member);
    write_load_values(root.create(name), values);
  }
  std::vector<std::int32_t> cell, patch, rank;
  std::vector<std::string> element;
  for (const SlaveElement& slave : contact.slaves) {
    cell.push_back(slave.cell);
    patch.push_back(slave.patch);
    rank.push_back(slave.rank);
    element.push_back(slave.element);
  }
  root.write("slave/cell", cell);
  root.write("slave/patch", patch);
  root.write("slave/rank", rank);
  root.write_strings("slave/element", element);
  if (contact.skins.empty()) return;
  cell.clear(), element.clear();
  for (const SkinElement& skin : contact.skins) {
    cell.push_back(skin.cell);
    element.push_back(skin.element);
  }
  root.write("skin/cell", cell);
  root.write_strings("skin/element", element);
}

std::vector<std::string> references(const Contact& contact) {
  std::vector<std::string> found{contact.model, contact.mesh};
  for (const ContactZone& zone : contact.zones)
    for (const auto& [name, member] : zone_values)
      if (const std::string& function = (zone.*member).function; !function.empty()) found.push_back(function);
  return found;
}

}  // namespace lacon::storage
