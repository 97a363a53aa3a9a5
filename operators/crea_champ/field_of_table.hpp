#pragma once
// CREA_CHAMP(OPERATION='EXTR', TABLE): values of a table at the places that its rows name.
#include "lacon/operators/fields/layout.hpp"
#include "lacon/structures/table.hpp"

namespace lacon {

/// Columns of reals are components, but those that tell where and when; of two rows for one place the later one counts. Throws
/// CREACHAMP_2, CREACHAMP_17 to 19.
/// @return a field on all of `ground`, present where the table has a value
Field field_of_table(const Table& table, const Ground& ground, const FieldType& type);

}  // namespace lacon
