#include "lacon/structures/storage/storage.hpp"

#include <nlohmann/json.hpp>

namespace lacon::storage {

using nlohmann::json;

namespace {

ResultStage read_stage(const json& from) {
  ResultStage stage{
      .first = from.at("first"), .contact = from.at("contact"), .loads = {}, .behaviour = from.at("behaviour").dump()};
  for (const json& load : from.at("loads"))
    stage.loads.push_back({load.at("load"), load.at("function"), load.value("type", "FIXE_CSTE")});
  return stage;
}

std::vector<ResultStage> read_stages(const hdf5::Group& root) {
  if (!root.has_attribute("stages"))  // format 1 had one for all orders
    return {read_stage({{"first", 0},
                        {"contact", root.text("contact")},
                        {"loads", json::parse(root.text("loads"))},
                        {"behaviour", json::parse(root.text("behaviour"))}})};
  std::vector<ResultStage> stages;
  for (const json& stage : json::parse(root.text("stages"))) stages.push_back(read_stage(stage));
  if (stages.empty()) throw std::out_of_range("no stage");
  return stages;
}

json written(const ResultStage& stage) {
  json loads = json::array();
  for (const ResultLoad& load : stage.loads)
    loads.push_back({{"load", load.load}, {"function", load.function}, {"type", load.type}});
  return {{"first", stage.first},
          {"contact", stage.contact},
          {"loads", std::move(loads)},
          {"behaviour", json::parse(stage.behaviour)}};
}

}  // namespace

Result read_result(const hdf5::Group& root) {
  Result result;
  result.label = root.text("label");
  if (result.label.empty()) result.label = root.text("id");
  result.model = root.text("model");
  result.mesh = root.text("mesh");
  result.material_field = root.text("material_field");
  result.stages = read_stages(root);
  if (root.has_attribute("complete")) result.complete = root.integer("complete") != 0;
  result.orders = root.read<std::int64_t>("order");
  result.instants = root.read<double>("instant");
  const hdf5::Group fields = root.open("fields");
  for (const std::string& name : fields.children()) {
    const hdf5::Group field = fields.open(name);
    const auto orders = field.read<std::int64_t>("order");
    const auto files = field.read_strings("file");
    for (std::size_t i = 0; i < orders.size(); ++i) result.fields[name][orders[i]] = files.at(i);
  }
  const hdf5::Group parameters = root.open("parameters");
  for (const std::string& name : parameters.children()) result.parameters[name] = parameters.read<double>(name);
  if (root.has("tables"))
    for (const std::string& name : root.open("tables").children())
      result.tables[name] = read_table(root.open("tables/" + name));
  return result;
}

void write(const hdf5::Group& root, const Result& result) {
  root.set("model", result.model);
  root.set("mesh", result.mesh);
  root.set("material_field", result.material_field);
  json stages = json::array();
  for (const ResultStage& stage : result.stages) stages.push_back(written(stage));
  root.set("stages", stages.dump());
  root.set("complete", std::int64_t{result.complete});
  root.write("order", result.orders);
  root.write("instant", result.instants);
  const hdf5::Group fields = root.create("fields");
  for (const auto& [name, files] : result.fields) {
    const hdf5::Group field = fields.create(name);
    std::vector<std::int64_t> orders;
    std::vector<std::string> paths;
    for (const auto& [order, file] : files) {
      orders.push_back(order);
      paths.push_back(file);
    }
    field.write("order", orders);
    field.write_strings("file", paths);
  }
  const hdf5::Group parameters = root.create("parameters");
  for (const auto& [name, values] : result.parameters) parameters.write(name, values);
  for (const auto& [name, table] : result.tables) write_table(root.create("tables/" + name), table);
}

std::vector<std::string> references(const Result& result) {
  std::vector<std::string> references{result.model, result.mesh, result.material_field};
  for (const ResultStage& stage : result.stages) {
    references.push_back(stage.contact);
    for (const ResultLoad& load : stage.loads) {
      references.push_back(load.load);
      references.push_back(load.function);
    }
  }
  return references;
}

}  // namespace lacon::storage
