#pragma once
// EXTR_RESU: some instants and fields of a result, in a result of its own or, with reuse, in its place.
#include "lacon/structures/base.hpp"

namespace lacon {

/// Throws FIELDS_1 to FIELDS_3 where the result has no such instant.
void extr_resu(const Order& order, const Base& base);

}  // namespace lacon
