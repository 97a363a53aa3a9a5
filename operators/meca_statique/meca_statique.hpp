#pragma once
// MECA_STATIQUE: linear elasticity with small strains, each instant by itself, on what STAT_NON_LINE is made of.
#include "lacon/structures/base.hpp"

namespace lacon {

void meca_statique(const Order& order, const Base& base);

}  // namespace lacon
