#include "lacon/structures/storage/storage.hpp"

#include <utility>

#include "lacon/structures/storage/pieces.hpp"

namespace lacon::storage {
namespace {

/// The zone's members that are plain texts, by the name of their dataset.
const std::pair<const char*, std::string ContactZone::*> zone_texts[] = {
    {"zones/slave_group", &ContactZone::slave_group},
    {"zones/master_group", &ContactZone::master_group},
    {"zones/jacobian", &ContactZone::jacobian},
    {"zones/search", &ContactZone::search},
    {"zones/initial_status", &ContactZone::initial_status}};

/// The zone's members that are a number.
const std::pair<const char*, double ContactZone::*> zone_numbers[] = {{"zones/tolerance", &ContactZone::tolerance},
                                                                      {"zones/distance_limit", &ContactZone::distance_limit}};

/// The zone's members that are lists of numbers.
const std::pair<const char*, std::vector<std::int32_t> ContactZone::*> zone_lists[] = {
    {"zones/slave", &ContactZone::slave}, {"zones/master", &ContactZone::master}, {"zones/patches", &ContactZone::patches}};

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
  if (root.has_attribute("elastic_iterations")) contact.elastic_iterations = root.integer("elastic_iterations");
  contact.zones.resize(root.read<double>("zones/tolerance").size());
  for (const auto& [name, member] : zone_numbers) {
    if (!root.has(name)) continue;  // a base older than the number
    const auto values = root.read<double>(name);
    for (std::size_t z = 0; z < contact.zones.size(); ++z) contact.zones[z].*member = values.at(z);
  }
  for (const auto& [name, member] : zone_texts) {
    const auto values = root.read_strings(name);
    for (std::size_t z = 0; z < contact.zones.size(); ++z) contact.zones[z].*member = values.at(z);
  }
  for (const auto& [name, member] : zone_lists) {
    const auto values = read_ragged<std::int32_t>(root, name);
    if (values.size() != contact.zones.size()) refuse(root, std::string("'") + name + "' does not fit 'zones/tolerance'");
    for (std::size_t z = 0; z < contact.zones.size(); ++z)
      (contact.zones[z].*member).assign(values[z].begin(), values[z].end());
  }
  const hdf5::Group slave = root.open("slave");
  const auto cell = slave.read<std::int32_t>("cell"), patch = slave.read<std::int32_t>("patch"),
             rank = slave.read<std::int32_t>("rank");
  const auto element = slave.read_strings("element");
  for (std::size_t i = 0; i < cell.size(); ++i) contact.slaves.push_back({cell[i], patch.at(i), rank.at(i), element.at(i)});
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
}

std::vector<std::string> references(const Contact& contact) { return {contact.model, contact.mesh}; }

}  // namespace lacon::storage
