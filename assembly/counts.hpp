#pragma once
// Counts that have to be numbers of 32 bits: rows and columns of matrices, and whatever METIS and MUMPS are given.
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"

namespace lacon {

/// @param what the part of messages that says what is counted  Throws SOLVER_16.
template <class Integer = std::int32_t>
Integer narrow_count(std::int64_t count, std::string_view what) {
  if (count > std::numeric_limits<Integer>::max()) fail("SOLVER_16", {{"count", std::to_string(count)}, {"what", part(what)}});
  return static_cast<Integer>(count);
}

}  // namespace lacon
