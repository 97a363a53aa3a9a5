#include "lacon/operators/fields/timed_values.hpp"

#include <algorithm>

namespace lacon {

void TimedValues::set(std::size_t i, std::shared_ptr<const StudyFunction> function, std::span<const double> point) {
  auto part = std::find_if(parts_.begin(), parts_.end(), [&](const Part& p) { return p.function == function; });
  if (part == parts_.end()) part = parts_.insert(part, {std::move(function), {}, {}, {}, {}});
  part->index.push_back(i);
  part->x.push_back(point[0]);
  part->y.push_back(point[1]);
  part->z.push_back(point[2]);
}

void TimedValues::evaluate(const Part& part, double instant, std::vector<double>& values) {
  const ParameterValues known[] = {{"X", part.x}, {"Y", part.y}, {"Z", part.z}, {"INST", {&instant, 1}}};
  const std::vector<double> found = part.function->values(part.index.size(), known);
  for (std::size_t k = 0; k < found.size(); ++k) values[part.index[k]] = found[k];
}

void TimedValues::settle() {
  std::erase_if(parts_, [&](const Part& part) {
    if (part.function->depends_on("INST")) return false;
    evaluate(part, 0.0, values_);
    return true;
  });
}

std::vector<double> TimedValues::at(double instant) const {
  std::vector<double> values = values_;
  for (const Part& part : parts_) evaluate(part, instant, values);
  return values;
}

}  // namespace lacon
