#pragma once
// The bodies of a problem, for messages that say which of them is meant and for those that nothing holds.
#include <cstdint>
#include <string>
#include <vector>

#include "lacon/structures/mesh.hpp"

namespace lacon {

/// What the cells of full dimension hold together.
class Bodies {
 public:
  explicit Bodies(const Mesh& mesh);
  /// The body of a node, by the lowest of its nodes; its own number where no cell of full dimension has it.
  std::int32_t of(std::int32_t node) const { return lowest_[static_cast<std::size_t>(node)]; }
  /// The largest group of cells that is all inside this body; without any "the body of M12".
  std::string name_at(std::int32_t node) const;

 private:
  const Mesh& mesh_;
  std::vector<std::int32_t> lowest_;  ///< of each node
};

}  // namespace lacon
