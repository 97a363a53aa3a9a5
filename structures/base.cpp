#include "lacon/structures/base.hpp"

#include <nlohmann/json.hpp>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/structures/storage/storage.hpp"

namespace lacon {

// ---------------------------------------------------------------------------------------------- where concepts are

std::filesystem::path Base::file(std::string_view id) const {
  const std::filesystem::path single = folder_ / (std::string(id) + ".h5");
  const std::filesystem::path index = folder_ / std::string(id) / "index.h5";
  std::error_code error;
  if (std::filesystem::exists(single, error)) return single;
  if (std::filesystem::exists(index, error)) return index;
  fail("BASE_1", {{"id", std::string(id)}, {"base", folder_.string()}});
}

std::string Base::type(std::string_view id) const { return hdf5::Reader(file(id)).text("lacon_type"); }

std::string Base::label(std::string_view id) const {
  std::string label = hdf5::Reader(file(id)).text("label");
  return label.empty() ? std::string(id) : label;
}

// ---------------------------------------------------------------------------------------------- reading

namespace {

/// A file in the place of another one.
[[noreturn]] void is_another(const std::filesystem::path& file, const std::string& found, const std::string& expected) {
  fail("BASE_7", {{"file", file.string()}, {"found", found}, {"expected", expected}});
}

/// Open a concept and check its type, and that the file is its own.
hdf5::Reader open_concept(const Base& base, std::string_view id, std::string_view type) {
  hdf5::Reader root(base.file(id));
  if (const std::string found = root.text("lacon_type"); found != type)
    fail("BASE_4", {{"id", std::string(id)}, {"found", found}, {"expected", std::string(type)}});
  if (const std::string found = root.text("id"); found != id) is_another(base.file(id), found, std::string(id));
  return root;
}

}  // namespace

Mesh Base::mesh(std::string_view id) const {
  return storage::read_whatever(open_concept(*this, id, "mesh"), storage::read_mesh);
}

Model Base::model(std::string_view id) const {
  return storage::read_whatever(open_concept(*this, id, "model"), storage::read_model);
}

Material Base::material(std::string_view id) const {
  return storage::read_whatever(open_concept(*this, id, "material"), storage::read_material);
}

ElementCharacteristics Base::element_characteristics(std::string_view id) const {
  return storage::read_whatever(open_concept(*this, id, "element_characteristics"), storage::read_element_characteristics);
}

MaterialField Base::material_field(std::string_view id) const {
  return storage::read_whatever(open_concept(*this, id, "material_field"), storage::read_material_field);
}

Load Base::load(std::string_view id) const {
  return storage::read_whatever(open_concept(*this, id, "load"), storage::read_load);
}

Contact Base::contact(std::string_view id) const {
  return storage::read_whatever(open_concept(*this, id, "contact"), storage::read_contact);
}

Function Base::function(std::string_view id) const {
  return storage::read_whatever(open_concept(*this, id, "function"), storage::read_function);
}

Formula Base::formula(std::string_view id) const {
  return storage::read_whatever(open_concept(*this, id, "formula"), storage::read_formula);
}

std::vector<double> Base::list_of_reals(std::string_view id) const {
  return storage::read_whatever(open_concept(*this, id, "list_of_reals"), storage::read_list_of_reals);
}

TimeSteps Base::time_steps(std::string_view id) const {
  if (type(id) == "list_of_reals") return {.values = list_of_reals(id), .action = {.cut = true}};
  return storage::read_whatever(open_concept(*this, id, "time_steps"), storage::read_time_steps);
}

Table Base::table(std::string_view id) const { return storage::read_whatever(open_concept(*this, id, "table"), read_table); }

Field Base::field(std::string_view id) const {
  open_concept(*this, id, "field");
  return read_field(file(id));
}

Field Base::field_head(std::string_view id) const {
  open_concept(*this, id, "field");
  return read_field_head(file(id));
}

Result Base::result(std::string_view id) const {
  return storage::read_whatever(open_concept(*this, id, "result"), storage::read_result);
}

namespace {

std::string field_of(std::string_view name, std::int64_t order) {
  return part("field_of_order", {{"field", std::string(name)}, {"order", std::to_string(order)}});
}

}  // namespace

Field Base::field(const Result& result, std::string_view name, std::int64_t order) const {
  const auto named = result.fields.find(std::string(name));
  if (named != result.fields.end())
    if (const auto file = named->second.find(order); file != named->second.end()) {
      const std::filesystem::path path = folder_ / file->second;
      Field field = read_field(path);
      const bool is_of_result = path.parent_path() != folder_;  // one of its own goes by another name here
      if (is_of_result && (field.name != name || field.order != order))
        is_another(path, field_of(field.name, field.order), field_of(name, order));
      return field;
    }
  std::string known;
  for (const auto& [field, files] : result.fields)
    if (files.contains(order)) known += (known.empty() ? "" : ", ") + field;
  fail("RESULT_1", {{"label", result.label},
                    {"field", std::string(name)},
                    {"order", std::to_string(order)},
                    {"known", known.empty() ? part("none") : known}});
}

// ---------------------------------------------------------------------------------------------- storing

namespace {

/// Attributes that every concept has.
void write_head(const hdf5::Group& root, const Order& order, std::string_view type, std::int64_t version,
                const std::vector<std::string>& references) {
  nlohmann::json list = nlohmann::json::array();
  for (const std::string& id : references)
    if (!id.empty()) list.push_back(id);
  root.set("lacon_type", type);
  root.set("format", storage::newest_format(type));
  root.set("version", version);
  root.set("id", order.result_id);
  root.set("label", order.result_label);
  root.set("command", order.command);
  root.set("keywords", order.keywords.values().dump());
  root.set("references", list.dump());
}

/// Write the order's result as a concept in one file.
template <class Write>
void store_in(const std::filesystem::path& file, std::int64_t version, const Order& order, std::string_view type,
              const std::vector<std::string>& references, Write write) {
  (type == "result" ? hdf5::write_sealed_at_once : hdf5::write_sealed)(file, [&](const hdf5::Group& root) {
    write_head(root, order, type, version, references);
    write(root);
  });
}

std::filesystem::path concept_file(const Base& base, const Order& order) { return base.folder() / (order.result_id + ".h5"); }

template <class Concept>
void store_concept(const Base& base, const Order& order, std::string_view type, const Concept& content) {
  store_in(concept_file(base, order), base.next_version(), order, type, storage::references(content),
           [&](const hdf5::Group& root) { storage::write(root, content); });
}

}  // namespace

std::int64_t Base::next_version() const {
  return order_->reuse ? hdf5::Reader(file(order_->result_id)).integer("version") + 1 : 1;
}

void Base::store(const Mesh& mesh) const { store_concept(*this, *order_, "mesh", mesh); }

void Base::store(const Model& model) const { store_concept(*this, *order_, "model", model); }

void Base::store(const ElementCharacteristics& characteristics) const {
  store_concept(*this, *order_, "element_characteristics", characteristics);
}

void Base::store(const MaterialField& field) const {
  std::vector<std::string> references = storage::references(field);
  for (const Keywords& temperature : order_->keywords.factors("AFFE_VARC"))  // which its readers find among its keywords
    for (const char* const keyword : {"CHAM_GD", "EVOL", "FONC_INST"})
      references.push_back(temperature.optional_concept(keyword).value_or(""));
  store_in(concept_file(*this, *order_), next_version(), *order_, "material_field", references,
           [&](const hdf5::Group& root) { storage::write(root, field); });
}

void Base::store(const Load& load) const { store_concept(*this, *order_, "load", load); }

void Base::store(const Contact& contact) const { store_concept(*this, *order_, "contact", contact); }

void Base::store(const Table& table) const {
  store_in(concept_file(*this, *order_), next_version(), *order_, "table", {},
           [&](const hdf5::Group& root) { write_table(root, table); });
}

void Base::store(const Field& field) const {
  std::vector<std::string> references{field.mesh};
  references.insert(references.end(), field.functions.begin(), field.functions.end());
  store_in(concept_file(*this, *order_), next_version(), *order_, "field", references,
           [&](const hdf5::Group& root) { write_field_content(root, field); });
}

void Base::store(const Result& result) const {
  std::filesystem::create_directories(folder_ / order_->result_id);
  const std::int64_t version = result.version > 0 ? result.version : next_version();
  store_in(folder_ / order_->result_id / "index.h5", version, *order_, "result", storage::references(result),
           [&](const hdf5::Group& root) { storage::write(root, result); });
}

void Base::add_field(Result& result, FieldRows rows) const {
  Field& field = rows.field;
  field.mesh = result.mesh;
  // the file of an earlier version stays as it is: a field computed again gets the next free name
  const std::string stem = order_->result_id + "/" + field.name + "_" + std::to_string(field.order);
  std::string file = stem + ".h5";
  std::error_code error;
  for (int again = 2; std::filesystem::exists(folder_ / file, error); ++again)
    file = stem + "_" + std::to_string(again) + ".h5";
  std::filesystem::create_directories(folder_ / order_->result_id);
  write_field(folder_ / file, rows);
  result.fields[field.name][field.order] = file;
}

void Base::discard(const Result& result) const {
  std::error_code error;
  for (const auto& [name, files] : result.fields)
    for (const auto& [order, file] : files) std::filesystem::remove(folder_ / file, error);
  std::filesystem::remove(folder_ / order_->result_id, error);  // only where it is empty
}

}  // namespace lacon
