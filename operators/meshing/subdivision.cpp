#include "lacon/operators/meshing/subdivision.hpp"

#include <ranges>

#include "lacon/elements/reference.hpp"

namespace lacon {

constexpr std::size_t max_nodes = 27;

std::array<double, 3> image(CellType type, std::span<const std::int32_t> nodes, std::span<const double> xi,
                            std::span<const double> coordinates) {
  std::array<double, max_nodes> shape;
  shape_functions(type, xi, {shape.data(), nodes.size()});
  std::array<double, 3> point{};
  for (std::size_t a = 0; a < nodes.size(); ++a)
    for (std::size_t k = 0; k < 3; ++k) point[k] += shape[a] * coordinates[3 * static_cast<std::size_t>(nodes[a]) + k];
  return point;
}

std::vector<std::int32_t> pick(std::span<const std::int32_t> from, std::span<const std::int8_t> which) {
  std::vector<std::int32_t> picked;
  for (const std::int8_t i : which) picked.push_back(from[static_cast<std::size_t>(i)]);
  return picked;
}

std::vector<Group> inherited(std::span<const Group> groups, std::span<const std::int32_t> first_heir) {
  std::vector<Group> made;
  for (const Group& group : groups) {
    Group& extended = made.emplace_back(Group{group.name, {}});
    const auto heirs_of = [&](std::int32_t member) {
      return std::views::iota(first_heir[static_cast<std::size_t>(member)], first_heir[static_cast<std::size_t>(member) + 1]);
    };
    std::size_t count = 0;
    for (const std::int32_t member : group.members) count += heirs_of(member).size();
    extended.members.reserve(count);
    for (const std::int32_t member : group.members)
      for (const std::int32_t heir : heirs_of(member)) extended.members.push_back(heir);
  }
  return made;
}

}  // namespace lacon
