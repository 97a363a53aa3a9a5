#include "lacon/structures/storage/storage.hpp"

#include <algorithm>
#include <utility>

#include "lacon/structures/storage/pieces.hpp"

namespace lacon::storage {
namespace {

/// The lists of a load: group in the file, dataset of its places, member.
struct LoadGroup {
  const char* name;
  const char* place;
  std::vector<LoadTerm> Load::*terms;
};
constexpr LoadGroup load_groups[] = {{"imposed", "node", &Load::imposed},   {"nodal_force", "node", &Load::nodal},
                                     {"pressure", "cell", &Load::pressure}, {"force", "cell", &Load::force},
                                     {"gravity", "cell", &Load::gravity},   {"initial_strain", "cell", &Load::strain}};

}  // namespace

Load read_load(const hdf5::Group& root) {
  Load load;
  load.model = root.text("model");
  load.kind = root.text("kind");
  for (const LoadGroup& kind : load_groups) {
    if (!root.has(kind.name)) continue;
    const hdf5::Group group = root.open(kind.name);
    const auto names = group.read_strings("component");
    const auto place = group.read<std::int32_t>(kind.place), index = group.read<std::int32_t>("component_index");
    const std::vector<LoadValue> values = read_load_values(group);
    for (std::size_t i = 0; i < place.size(); ++i)
      (load.*kind.terms).push_back({place[i], names.at(static_cast<std::size_t>(index.at(i))), values.at(i)});
  }
  if (root.has("relations")) {
    const hdf5::Group group = root.open("relations");
    const auto names = group.read_strings("component"), source = group.read_strings("source");
    const auto node = read_ragged<std::int32_t>(group, "offset", "node");
    const auto index = group.read<std::int32_t>("component_index");
    const auto coefficient = group.read<double>("coefficient");
    const std::vector<LoadValue> values = read_load_values(group);
    for (std::size_t r = 0, at = 0; r < node.size(); ++r) {
      Relation relation{source.at(r), {}, values.at(r)};
      for (const std::int32_t n : node[r]) {
        relation.terms.push_back({n, names.at(static_cast<std::size_t>(index.at(at))), coefficient.at(at)});
        ++at;
      }
      load.relations.push_back(std::move(relation));
    }
  }
  return load;
}

void write(const hdf5::Group& root, const Load& load) {
  root.set("model", load.model);
  root.set("kind", load.kind);
  for (const LoadGroup& kind : load_groups) {
    if ((load.*kind.terms).empty()) continue;
    Names names;
    std::vector<std::int32_t> place, index;
    std::vector<LoadValue> values;
    for (const LoadTerm& term : load.*kind.terms) {
      place.push_back(term.place);
      index.push_back(names.number(term.component));
      values.push_back(term.value);
    }
    const hdf5::Group group = root.create(kind.name);
    group.write_strings("component", names.all());
    group.write(kind.place, place);
    group.write("component_index", index);
    write_load_values(group, values);
  }
  if (!load.relations.empty()) {
    Names names;
    Ragged<std::int32_t> node;
    std::vector<std::int32_t> index;
    std::vector<double> coefficient;
    std::vector<std::string> source;
    std::vector<LoadValue> values;
    for (const Relation& relation : load.relations) {
      source.push_back(relation.source);
      values.push_back(relation.value);
      for (const RelationTerm& term : relation.terms) {
        node.values.push_back(term.node);
        index.push_back(names.number(term.component));
        coefficient.push_back(term.coefficient);
      }
      node.offset.push_back(static_cast<std::int64_t>(node.values.size()));
    }
    const hdf5::Group group = root.create("relations");
    group.write_strings("source", source);
    group.write_strings("component", names.all());
    group.write("offset", node.offset);
    group.write("node", node.values);
    group.write("component_index", index);
    group.write("coefficient", coefficient);
    write_load_values(group, values);
  }
}

std::vector<std::string> references(const Load& load) {
  std::vector<std::string> references{load.model};
  const auto refer = [&](const LoadValue& value) {
    if (!value.function.empty() && std::find(references.begin(), references.end(), value.function) == references.end())
      references.push_back(value.function);
  };
  for (const LoadGroup& kind : load_groups)
    for (const LoadTerm& term : load.*kind.terms) refer(term.value);
  for (const Relation& relation : load.relations) refer(relation.value);
  return references;
}

}  // namespace lacon::storage
