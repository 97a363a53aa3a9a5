#include "lacon/assembly/petsc/aggregates.hpp"

#include <algorithm>
#include <utility>

namespace lacon {
namespace {

constexpr std::int32_t none = -1;

/// The aggregate that most of some nodes are in; of two alike the first one.
class MostCommon {
 public:
  explicit MostCommon(std::int32_t n_aggregates) : votes_(n_aggregates, 0) {}

  std::int32_t of(std::span<const std::int32_t> nodes, std::span<const std::int32_t> aggregate_of) {
    std::int32_t most = none;
    for (const std::int32_t node : nodes)
      if (const std::int32_t a = aggregate_of[node]; a != none) {
        ++votes_[a];
        if (most == none || std::pair(-votes_[a], a) < std::pair(-votes_[most], most)) most = a;
      }
    for (const std::int32_t node : nodes)
      if (const std::int32_t a = aggregate_of[node]; a != none) votes_[a] = 0;
    return most;
  }

 private:
  std::vector<std::int32_t> votes_;
};

}  // namespace

Aggregates aggregated(const NodeGraph& graph, std::span<const std::uint8_t> takes_part) {
  const auto n = static_cast<std::int32_t>(takes_part.size());
  Aggregates made{.of_node = std::vector<std::int32_t>(n, none)};
  std::vector<std::int32_t>& aggregate = made.of_node;
  const auto is_left = [&](std::int32_t node) { return takes_part[node] && aggregate[node] == none; };
  const auto put_together = [&](std::int32_t node) {
    aggregate[node] = made.count;
    for (const std::int32_t other : graph.of(node))
      if (is_left(other)) aggregate[other] = made.count;
    ++made.count;
  };

  for (std::int32_t node = 0; node < n; ++node)
    if (is_left(node) && std::ranges::all_of(graph.of(node), [&](std::int32_t other) { return aggregate[other] == none; }))
      put_together(node);

  const std::vector<std::int32_t> whole = aggregate;
  MostCommon most_common(made.count);
  for (std::int32_t node = 0; node < n; ++node)
    if (is_left(node)) aggregate[node] = most_common.of(graph.of(node), whole);

  for (std::int32_t node = 0; node < n; ++node)
    if (is_left(node)) put_together(node);
  return made;
}

}  // namespace lacon
