#include "lacon/operators/fields/expected.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/quantities.hpp"

namespace lacon {

std::string type_of(const Field& field) { return fmt::format("{}_{}", location_name(field.location), field.quantity); }

void check_field(const Field& field, std::span<const std::string_view> types, const std::string& keyword,
                 const std::string& label) {
  if (std::find(types.begin(), types.end(), type_of(field)) != types.end()) return;
  fail("FIELDS_6", {{"keyword", keyword},
                    {"field", label},
                    {"type", type_of(field)},
                    {"wanted", fmt::format("{}", fmt::join(types, ", "))}});
}

void check_result_field(const Field& field, const std::string& name, const std::string& keyword, const std::string& label) {
  const auto rows = catalog::result_fields();
  const auto row = std::find_if(rows.begin(), rows.end(), [&](const catalog::ResultFieldRow& r) { return r.name == name; });
  if (row != rows.end()) return check_field(field, row->types, keyword, label);
  constexpr std::array<std::string_view, 4> places{"NOEU", "ELGA", "ELNO", "ELEM"};
  const auto place = std::find_if(places.begin(), places.end(), [&](std::string_view p) { return name.ends_with(p); });
  if (place != places.end() && location_name(field.location) != *place)
    fail("FIELDS_7", {{"keyword", keyword}, {"field", label}, {"type", type_of(field)}, {"name", name}});
}

Result with_model(const Base& base, Result result, const Keywords& keywords) {
  if (const auto model = keywords.optional_concept("MODELE"); model && result.model.empty()) {
    if (const std::string mesh = base.model(*model).mesh; mesh != result.mesh)
      fail("CREACHAMP_5", {{"first", base.label(result.mesh)}, {"second", base.label(mesh)}});
    result.model = *model;
  }
  if (const auto materials = keywords.optional_concept("CHAM_MATER"); materials && result.material_field.empty())
    result.material_field = *materials;
  return result;
}

Model model_of(const Base& base, const Result& result) {
  if (result.model.empty()) fail("FIELDS_8", {{"label", result.label}, {"keyword", "MODELE"}});
  return base.model(result.model);
}

MaterialField materials_of(const Base& base, const Result& result) {
  if (result.material_field.empty()) fail("FIELDS_8", {{"label", result.label}, {"keyword", "CHAM_MATER"}});
  return base.material_field(result.material_field);
}

}  // namespace lacon
