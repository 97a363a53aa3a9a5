#pragma once
// Short names for rows of statuses.
#include "lacon/operators/contact/patches.hpp"

namespace lacon {

constexpr Status A = Status::active, O = Status::open, U = Status::unpaired;

}  // namespace lacon
