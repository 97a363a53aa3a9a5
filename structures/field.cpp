#include "lacon/structures/field.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/structures/hdf5.hpp"
#include "lacon/structures/storage/storage.hpp"

namespace lacon {
namespace {
constexpr std::array<std::string_view, 4> location_names{"NOEU", "ELGA", "ELNO", "ELEM"};
}

std::string_view location_name(Location location) { return location_names[static_cast<std::size_t>(location)]; }

Location find_location(std::string_view name) {
  const auto at = std::find(location_names.begin(), location_names.end(), name);
  if (at == location_names.end()) throw std::logic_error("no location is called " + std::string(name));
  return static_cast<Location>(at - location_names.begin());
}

int Field::component(std::string_view component_name) const {
  const auto at = std::find(components.begin(), components.end(), component_name);
  return at == components.end() ? -1 : static_cast<int>(at - components.begin());
}

void put_markers(Field& field) {
  for (std::size_t k = 0; k < field.present.size(); ++k)
    if (field.present[k] == Field::marker) field.values[k] = Field::no_value;
}

std::optional<Extreme> find_extreme(const Field& field, std::size_t component, bool greatest,
                                    const std::function<bool(std::size_t)>& wanted) {
  std::optional<Extreme> best;
  for (const Field::Presence looked_at : {Field::there, Field::stand_in, Field::marker}) {
    for (std::size_t i = 0; i < field.support.size(); ++i) {
      if (!wanted(i)) continue;
      for (std::size_t row = field.first_row(i); row < field.first_row(i + 1); ++row) {
        const double value = field.at(row, component);
        if (field.presence(row, component) != looked_at) continue;
        if (!best || (greatest ? value > best->value : value < best->value)) best = {value, i, row};
      }
    }
    if (best) break;
  }
  return best;
}

namespace {

Field head_of(const hdf5::Group& root) {
  Field field;
  field.name = root.text("name");
  field.quantity = root.text("quantity");
  field.location = find_location(root.text("location"));
  field.components = root.attribute_strings("components");
  field.mesh = root.text("mesh");
  field.order = root.integer("order");
  field.instant = root.real("instant");
  if (root.has_attribute("functions")) field.functions = root.attribute_strings("functions");
  return field;
}

}  // namespace

namespace {

/// Whether there is a row wherever Field says so.
bool is_sound(const Field& field) {
  const std::vector<std::int64_t>& offset = field.offset;
  const std::size_t rows = field.n_rows();
  const bool each_has_rows = offset.empty() ? field.support.size() == rows
                                            : offset.size() == field.support.size() + 1 && offset.front() == 0 &&
                                                  std::is_sorted(offset.begin(), offset.end()) &&
                                                  offset.back() == static_cast<std::int64_t>(rows);
  const auto names_function = [&](double value) { return value >= 0 && value < static_cast<double>(field.functions.size()); };
  return each_has_rows && field.values.size() == rows * field.n_components() &&
         (field.present.empty() || field.present.size() == field.values.size()) &&
         std::all_of(field.support.begin(), field.support.end(), [](std::int32_t i) { return i >= 0; }) &&
         (field.functions.empty() || std::all_of(field.values.begin(), field.values.end(), names_function));
}

}  // namespace

Field read_field_head(const std::filesystem::path& file) { return storage::read_whatever(hdf5::Reader(file), head_of); }

Field read_field(const std::filesystem::path& file) {
  const hdf5::Reader root(file);
  Field field = storage::read_whatever(root, head_of);
  field.support = root.read<std::int32_t>("support");
  if (root.has("offset")) field.offset = root.read<std::int64_t>("offset");
  field.values = root.read<double>("values");
  if (root.has("present")) field.present = root.read<std::uint8_t>("present");
  if (!is_sound(field)) fail("BASE_2", {{"file", file.string()}, {"reason", part("field_does_not_fit")}});
  return field;
}

namespace {

/// Without values and what says which of them are there.
void write_head(const hdf5::Group& root, const Field& field) {
  root.set("name", field.name);
  root.set("quantity", field.quantity);
  root.set("location", location_name(field.location));
  root.set("components", field.components);
  root.set("mesh", field.mesh);
  root.set("order", field.order);
  root.set("instant", field.instant);
  if (!field.functions.empty()) root.set("functions", field.functions);
  root.write("support", field.support);
  if (!field.offset.empty()) root.write("offset", field.offset);
}

/// Of a field whose values are made.
std::size_t n_rows(const FieldRows& rows) {
  return rows.field.components.empty() ? 0 : rows.field.first_row(rows.field.support.size());
}

}  // namespace

Field FieldRows::whole() && {
  if (!values) return std::move(field);
  field.values.resize(n_rows(*this) * field.n_components());
  values(field, 0, field.values);
  if (present) {
    field.present.resize(field.values.size());
    present(field, 0, field.present);
  }
  return std::move(field);
}

void write_field_content(const hdf5::Group& root, const Field& field) {
  write_head(root, field);
  const std::vector<hsize_t> shape{field.n_rows(), field.n_components()};
  root.write("values", field.values, shape);
  if (!field.present.empty()) root.write("present", field.present, shape);
}

void write_field(const std::filesystem::path& file, const FieldRows& rows) {
  hdf5::write_sealed(file, [&](const hdf5::Group& root) {
    root.set("lacon_type", "field");
    root.set("format", storage::format);
    if (!rows.values) return write_field_content(root, rows.field);
    write_head(root, rows.field);
    const std::vector<hsize_t> shape{n_rows(rows), rows.field.n_components()};
    const auto write = [&]<class T>(const char* name, const FieldRows::Fill<T>& make) {
      root.write_rows<T>(name, shape, [&](std::size_t first, std::span<T> some) { make(rows.field, first, some); });
    };
    write("values", rows.values);
    if (rows.present) write("present", rows.present);
  });
}

}  // namespace lacon
