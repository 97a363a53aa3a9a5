#include "lacon/structures/names.hpp"

#include <charconv>
#include <limits>

namespace lacon {

std::optional<std::int32_t> number_in_name(std::string_view name, Entity entity) {
  const std::string_view longer = entity == Entity::node ? "NO" : "MA";
  const std::string_view digits = name.substr(name.starts_with(longer) ? 2 : name.starts_with(longer[0]) ? 1 : name.size());
  std::int64_t number = 0;
  const char* const end = digits.data() + digits.size();
  if (digits.empty() || digits[0] == '0' || digits[0] == '-' || std::from_chars(digits.data(), end, number).ptr != end ||
      number < 1 || number > std::numeric_limits<std::int32_t>::max())
    return std::nullopt;
  return static_cast<std::int32_t>(number - 1);
}

std::optional<std::int32_t> find_by_name(const Mesh& mesh, std::string_view name, Entity entity) {
  const bool node = entity == Entity::node;
  if (const Group* group = node ? mesh.find_node_group(name) : mesh.find_cell_group(name); group && group->members.size() == 1)
    return group->members[0];
  const std::optional<std::int32_t> number = number_in_name(name, entity);
  if (!number || static_cast<std::size_t>(*number) >= (node ? mesh.n_nodes() : mesh.n_cells())) return std::nullopt;
  return number;
}

}  // namespace lacon
