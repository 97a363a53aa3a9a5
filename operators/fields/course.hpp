#pragma once
// A field of a result over its instants: which have it, and what it is between two of them.
#include <cstdint>
#include <string>
#include <vector>

#include "lacon/structures/concepts.hpp"
#include "lacon/structures/field.hpp"

namespace lacon {

struct FieldInstant {
  double instant;
  std::int64_t order;
};

/// Those that have the field, by increasing instants, in whatever order they were added.
std::vector<FieldInstant> course_of(const Result& result, const std::string& name);

/// What two fields have in common to be looked at between them: components and places.
bool on_the_same_places(const Field& first, const Field& second);

/// On the line from one field to another at the same places, at this share of the way. What is a stand-in or a marker in either
/// is one, what one of them has not is not there.
Field between(Field first, const Field& second, double share);

}  // namespace lacon
