#pragma once
// What commands expect of what they are given: fields of a type, results that say their model and materials.
#include <span>
#include <string>
#include <string_view>

#include "lacon/structures/base.hpp"

namespace lacon {

/// TYPE_CHAM of a field: "NOEU_DEPL_R".
std::string type_of(const Field& field);

/// Refuse a field that is of none of these types: FIELDS_6. @param label the field's, for messages
void check_field(const Field& field, std::span<const std::string_view> types, const std::string& keyword,
                 const std::string& label);
/// The same for a field that goes into a result by this name (catalog/quantities.toml); of a name that is nobody's, but says a
/// place (X_ELGA), the field must live there: FIELDS_7.
void check_result_field(const Field& field, const std::string& name, const std::string& keyword, const std::string& label);

/// Refuse two meshes, by their ids, that have to be one: CREACHAMP_5.
void check_same_mesh(const Base& base, const std::string& first, const std::string& second);
/// Refuse what MAILLAGE and MODELE, under these names, say where it is not on this mesh: CREACHAMP_5.
void check_own_mesh(const Base& base, const std::string& mesh, const Keywords& keywords, std::string_view mesh_keyword,
                    std::string_view model_keyword);

/// The result with MODELE and CHAM_MATER of the command where it names none itself (CREA_RESU). Throws CREACHAMP_5 for a model
/// on another mesh.
Result with_model(const Base& base, Result result, const Keywords& keywords);
/// The model of a result; throws FIELDS_8 where it names none.
Model model_of(const Base& base, const Result& result);
/// The materials of a result; throws FIELDS_8 where it names none, CREACHAMP_5 where they are of another mesh.
MaterialField materials_of(const Base& base, const Result& result);

}  // namespace lacon
