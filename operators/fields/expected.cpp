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

void check_same_mesh(const Base& base, const std::string& first, const std::string& second) {
  if (first != second) fail("CREACHAMP_5", {{"first", base.label(first)}, {"second", base.label(second)}});
}

void check_own_mesh(const Base& base, const std::string& mesh, const Keywords& keywords, std::string_view mesh_keyword,
                    std::string_view model_keyword) {
  if (const auto given = keywords.optional_concept(mesh_keyword)) check_same_mesh(base, mesh, *given);
  if (const auto given = keywords.optional_concept(model_keyword)) check_same_mesh(base, mesh, base.model(*given).mesh);
}

Result with_model(const Base& base, Result result, const Keywords& keywords) {
  if (const auto model = keywords.optional_concept("MODELE"); model && result.model.empty()) {
    check_same_mesh(base, result.mesh, base.model(*model).mesh);
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
  MaterialField field = base.material_field(result.material_field);
  check_same_mesh(base, result.mesh, field.mesh);
  return field;
}

}  // namespace lacon
