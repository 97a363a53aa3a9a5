#include "lacon/operators/crea_resu/crea_resu.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/operators/fields/expected.hpp"
#include "lacon/operators/program/study_function.hpp"

namespace lacon {
namespace {

/// A field of functions at nodes, at an instant: of X, Y, Z and INST.
Field evaluated(const Base& base, const Field& functions, const Mesh& mesh, double instant, const std::string& keyword) {
  if (functions.location != Location::nodes) fail("CREARESU_3", {{"keyword", keyword}, {"field", functions.name}});
  Field field = functions;
  field.functions.clear();
  field.quantity.back() = 'R';
  for (std::size_t f = 0; f < functions.functions.size(); ++f) {
    std::vector<std::size_t> places;  // of values
    std::vector<double> axes[3];
    for (std::size_t row = 0; row < functions.n_rows(); ++row)
      for (std::size_t c = 0; c < functions.n_components(); ++c) {
        if (!functions.has(row, c) || functions.at(row, c) != static_cast<double>(f)) continue;
        places.push_back(row * functions.n_components() + c);
        const auto point = mesh.point(functions.support[row]);
        for (std::size_t d = 0; d < 3; ++d) axes[d].push_back(point[d]);
      }
    const ParameterValues known[] = {{"X", axes[0]}, {"Y", axes[1]}, {"Z", axes[2]}, {"INST", {&instant, 1}}};
    const std::vector<double> values = StudyFunction(base, functions.functions[f]).values(places.size(), known);
    for (std::size_t k = 0; k < places.size(); ++k) field.values[places[k]] = values[k];
  }
  return field;
}

std::vector<double> instants_of(const Keywords& factor, const Base& base) {
  if (!factor.has("LIST_INST")) return factor.reals("INST");
  const std::vector<double> list = base.list_of_reals(factor.concept_id("LIST_INST"));
  const auto first = static_cast<std::size_t>(factor.optional_integer("NUME_INIT").value_or(1) - 1),
             last =
                 static_cast<std::size_t>(factor.optional_integer("NUME_FIN").value_or(static_cast<std::int64_t>(list.size())));
  if (first >= last || last > list.size())
    fail("CREARESU_1", {{"keyword", factor.path("NUME_INIT")}, {"what", part("instant_of_list")}});
  return {list.begin() + static_cast<std::ptrdiff_t>(first), list.begin() + static_cast<std::ptrdiff_t>(last)};
}

/// The order of an instant, a new one behind all where the result does not have it.
std::int64_t order_at(Result& result, double instant, const Keywords& factor) {
  const double precision = factor.real("PRECISION"),
               tolerance = factor.text("CRITERE") == "RELATIF" ? precision * std::abs(instant) : precision;
  for (std::size_t k = 0; k < result.orders.size(); ++k)
    if (std::abs(result.instants[k] - instant) <= tolerance) return result.orders[k];
  result.orders.push_back(result.orders.empty() ? 0 : result.orders.back() + 1);
  result.instants.push_back(instant);
  for (auto& [name, values] : result.parameters) values.push_back(0);
  return result.orders.back();
}

}  // namespace

void crea_resu(const Order& order, const Base& base) {
  const Keywords& keywords = order.keywords;
  Result result;
  if (order.reuse) result = base.result(order.result_id);
  result.version = 0;
  result.label = order.result_label;
  std::optional<Mesh> mesh;
  for (const Keywords& factor : keywords.factors("AFFE")) {
    const Field field = base.field(factor.concept_id("CHAM_GD"));
    if (result.mesh.empty()) result.mesh = field.mesh;
    if (field.mesh != result.mesh)
      fail("CREARESU_2", {{"keyword", factor.path("CHAM_GD")}, {"field", base.label(factor.concept_id("CHAM_GD"))}});
    if (const auto model = factor.optional_concept("MODELE")) result.model = *model;
    if (const auto materials = factor.optional_concept("CHAM_MATER")) result.material_field = *materials;
    const std::string name = factor.has("NOM_CHAM")     ? factor.text("NOM_CHAM")
                             : keywords.has("NOM_CHAM") ? keywords.text("NOM_CHAM")
                                                        : "";
    if (name.empty()) fail("CREARESU_1", {{"keyword", factor.path("NOM_CHAM")}, {"what", part("field_name")}});
    for (const double instant : instants_of(factor, base)) {
      Field own = field;
      if (field.quantity.ends_with("_F")) {
        if (!mesh) mesh = base.mesh(result.mesh);
        own = evaluated(base, field, *mesh, instant, factor.path("CHAM_GD"));
      }
      check_result_field(own, name, factor.path("CHAM_GD"), base.label(factor.concept_id("CHAM_GD")));
      own.name = name;
      own.order = order_at(result, instant, factor);
      own.instant = instant;
      base.add_field(result, std::move(own));
    }
  }
  base.store(result);
}

}  // namespace lacon
