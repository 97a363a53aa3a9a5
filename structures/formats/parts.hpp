#pragma once
// Fields whose components live on different rows, taken apart: files of other programs know no missing components.
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "lacon/structures/field.hpp"

namespace lacon {

/// Components of a field that exist on the same rows, with these rows.
struct FieldPart {
  std::vector<std::size_t> components;
  std::vector<std::uint8_t> rows;  ///< 1 where they exist; all rows of the field
};

/// The parts of a field, in the order of their first components; components that exist nowhere are left out. The first part
/// bears the field's name.
std::vector<FieldPart> parts_of(const Field& field);

/// The name of a part in a file: `name`, and for the second part and later ones its components behind it, `<name>_LAGS_C`.
std::string part_name(const Field& field, const FieldPart& part, std::string_view name);

}  // namespace lacon
