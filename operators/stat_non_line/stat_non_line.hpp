#pragma once
// STAT_NON_LINE: quasi-static equilibrium with contact.
#include "lacon/structures/base.hpp"

namespace lacon {

/// Compute every instant of the order and store the result. A failure stores what has been computed before it, then is thrown
/// on. Where the program only checks, it ends before the first instant and stores nothing.
void stat_non_line(const Order& order, const Base& base);

}  // namespace lacon
