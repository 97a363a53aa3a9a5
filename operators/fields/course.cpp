#include "lacon/operators/fields/course.hpp"

#include <algorithm>

namespace lacon {

std::vector<FieldInstant> course_of(const Result& result, const std::string& name) {
  std::vector<FieldInstant> course;
  const auto files = result.fields.find(name);
  if (files == result.fields.end()) return course;
  for (std::size_t k = 0; k < result.orders.size(); ++k)
    if (files->second.contains(result.orders[k])) course.push_back({result.instants[k], result.orders[k]});
  std::ranges::stable_sort(course, {}, &FieldInstant::instant);
  return course;
}

bool on_the_same_places(const Field& first, const Field& second) {
  return first.components == second.components && first.support == second.support && first.offset == second.offset;
}

Field between(Field first, const Field& second, double share) {
  for (std::size_t k = 0; k < first.values.size(); ++k) first.values[k] += share * (second.values[k] - first.values[k]);
  if (first.present.empty()) first.present = second.present;
  for (std::size_t k = 0; k < second.present.size(); ++k) {
    first.present[k] = made_of(static_cast<Field::Presence>(first.present[k]), static_cast<Field::Presence>(second.present[k]));
    if (!first.present[k]) first.values[k] = 0;
  }
  put_markers(first);
  return first;
}

}  // namespace lacon
