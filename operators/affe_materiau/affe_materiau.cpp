#include "lacon/operators/affe_materiau/affe_materiau.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"

namespace lacon {
namespace {

/// AFFE_VARC stays with the field as its keywords (operators/fields/thermal.hpp); fields and groups must be those of the mesh.
void check_temperatures(const MaterialField& field, const Base& base, const Mesh& mesh, const Keywords& keywords) {
  for (const Keywords& factor : keywords.factors("AFFE_VARC")) {
    for (const std::string& group : factor.texts("GROUP_MA")) cells_of_group(mesh, group, factor.path("GROUP_MA"));
    const bool evolves = factor.has("EVOL");
    const std::string id = factor.concept_id(evolves ? "EVOL" : "CHAM_GD");
    if ((evolves ? base.result(id).mesh : base.field_head(id).mesh) != field.mesh)
      fail("MATERIAU_2", {{"keyword", factor.path(evolves ? "EVOL" : "CHAM_GD")},
                          {"field", base.label(id)},
                          {"mesh", base.label(field.mesh)}});
  }
}

}  // namespace

MaterialField affe_materiau(const Base& base, const Keywords& keywords) {
  MaterialField field;
  field.model = keywords.optional_concept("MODELE").value_or("");
  const std::string model_mesh = field.model.empty() ? "" : base.model(field.model).mesh;
  field.mesh = keywords.optional_concept("MAILLAGE").value_or(model_mesh);
  if (!model_mesh.empty() && model_mesh != field.mesh)
    fail("MATERIAU_1",
         {{"model", base.label(field.model)}, {"model_mesh", base.label(model_mesh)}, {"mesh", base.label(field.mesh)}});
  const Mesh mesh = base.mesh(field.mesh);
  field.material.assign(mesh.n_cells(), -1);
  for (const Keywords& factor : keywords.factors("AFFE")) {
    const std::string id = factor.concept_id("MATER");
    base.material(id);  // it exists, and is a material
    auto at = std::find(field.materials.begin(), field.materials.end(), id);
    if (at == field.materials.end()) at = field.materials.insert(at, id);
    const auto index = static_cast<std::int32_t>(at - field.materials.begin());
    if (factor.has("TOUT")) std::fill(field.material.begin(), field.material.end(), index);
    for (const std::string& group : factor.texts("GROUP_MA"))
      for (const std::int32_t cell : cells_of_group(mesh, group, factor.path("GROUP_MA")))
        field.material[static_cast<std::size_t>(cell)] = index;
  }
  check_temperatures(field, base, mesh, keywords);
  for (std::size_t i = 0; i < field.materials.size(); ++i)
    fmt::print("  {:<24} {:>9} {}\n", base.label(field.materials[i]),
               std::count(field.material.begin(), field.material.end(), static_cast<std::int32_t>(i)), part("cells"));
  return field;
}

}  // namespace lacon
