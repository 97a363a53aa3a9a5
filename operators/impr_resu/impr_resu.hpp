#pragma once
// IMPR_RESU: meshes and fields to files of other programs.
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "lacon/structures/base.hpp"

namespace lacon {

/// What one occurrence of RESU means of a result, in the order of instants.
struct PrintedField {
  std::string name_in_med;
  Field field;
};

/// Visit the fields that an occurrence of RESU means (CHAM_GD: of the result that stands for it), each restricted to its
/// components, nodes and cells; orders rise, fields come by name or as NOM_CHAM lists them. Fields that NOM_CHAM names are
/// mandatory where instants are named too; those that are left out are told with the reason (IMPR_5). Throws RESULT_1, IMPR_1
/// (field that is nowhere), IMPR_2 (component), IMPR_3 (GROUP_NO and a field of cells), IMPR_4 (NOM_CHAM_MED), and what
/// selected_orders() throws.
void each_field(const Base& base, const Result& result, const Mesh& mesh, const Keywords& keywords,
                const std::function<void(PrintedField&&)>& visit);

/// The name of a result's field in a MED file, as code_aster's users know it: the result's name filled up with underscores to
/// eight characters, then the field's: RESU____DEPL. A longer name gets one underscore.
std::string med_field_name(const std::string& label, const std::string& field);

/// Write what an order of IMPR_RESU asks for. @return what was written and where, a line each
std::vector<std::string> impr_resu(const Order& order, const Base& base);

}  // namespace lacon
