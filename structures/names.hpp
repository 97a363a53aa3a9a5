#pragma once
// Nodes and cells by the names that a user gives them.
#include <cstdint>
#include <optional>
#include <string_view>

#include "lacon/structures/mesh.hpp"

namespace lacon {

enum class Entity { node, cell };

/// The number in N12 or NO12 (a node), M12 or MA12 (a cell), 0-based; nothing for any other text.
std::optional<std::int32_t> number_in_name(std::string_view name, Entity entity);

/// The node or cell of a name: the one member of the group of this name, or the number in it. Nothing where there is none.
std::optional<std::int32_t> find_by_name(const Mesh& mesh, std::string_view name, Entity entity);

}  // namespace lacon
