#include "lacon/structures/storage/pieces.hpp"

namespace lacon::storage {

void write_load_values(const hdf5::Group& group, const std::vector<LoadValue>& values) {
  Names functions;
  std::vector<double> number;
  std::vector<std::int32_t> index;
  for (const LoadValue& v : values) {
    number.push_back(v.value);
    index.push_back(v.function.empty() ? -1 : functions.number(v.function));
  }
  group.write("value", number);
  if (functions.all().empty()) return;
  group.write_strings("function", functions.all());
  group.write("function_index", index);
}

std::vector<LoadValue> read_load_values(const hdf5::Group& group) {
  std::vector<LoadValue> values;
  for (const double number : group.read<double>("value")) values.push_back({number, ""});
  if (!group.has("function_index")) return values;
  const auto functions = group.read_strings("function");
  const auto index = group.read<std::int32_t>("function_index");
  for (std::size_t i = 0; i < values.size(); ++i)
    if (index.at(i) >= 0) values[i].function = functions.at(static_cast<std::size_t>(index[i]));
  return values;
}

}  // namespace lacon::storage
