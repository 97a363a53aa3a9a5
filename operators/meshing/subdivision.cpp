#include "lacon/operators/meshing/subdivision.hpp"

#include <algorithm>
#include <limits>

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

CellNodes pick(std::span<const std::int32_t> from, std::span<const std::int8_t> which) {
  CellNodes picked;
  for (const std::int8_t i : which) picked.push_back(from[static_cast<std::size_t>(i)]);
  return picked;
}

Heirs::Gap Heirs::gap_of(std::int32_t cell, std::size_t guess) const {
  const auto gap = [&](std::size_t i) {
    return Gap{i, i > 0 ? replaced_[i - 1] : -1,
               i < replaced_.size() ? replaced_[i] : std::numeric_limits<std::int32_t>::max()};
  };
  if (const Gap guessed = gap(guess); guessed.below < cell && cell <= guessed.end) return guessed;
  return gap(static_cast<std::size_t>(std::ranges::lower_bound(replaced_, cell) - replaced_.begin()));
}

Heirs::Range Heirs::of(std::int32_t cell) const {
  const Gap gap = gap_of(cell, 0);
  return {cell + shift_[gap.index], cell < gap.end ? 1 : 1 + added_at_end(gap)};
}

void Heirs::inherit(std::span<Group> groups) const {
  for (Group& group : groups) {
    std::vector<std::int32_t>& members = group.members;
    // most groups ascend, so that the next gap is the next guess
    std::size_t n = members.size(), end = n, guess = 0;
    for (std::size_t i = 0; i < n;) {
      const Gap gap = gap_of(members[i], guess);
      while (i < n && gap.has_inside(members[i])) ++i;
      if (i < n && members[i] == gap.end) {
        end += static_cast<std::size_t>(added_at_end(gap));
        ++i;
      }
      guess = std::min(gap.index + 1, replaced_.size());
    }
    members.resize(end);
    while (n > 0) {  // back to front: nothing unread is overwritten
      const Gap gap = gap_of(members[n - 1], guess);
      const std::int32_t shift = shift_[gap.index];
      if (members[n - 1] == gap.end) {
        --n;
        for (std::int32_t heir = gap.end + shift + added_at_end(gap); heir >= gap.end + shift; --heir) members[--end] = heir;
      }
      while (n > 0 && gap.has_inside(members[n - 1])) members[--end] = members[--n] + shift;
      guess = gap.index - (gap.index > 0 ? 1 : 0);
    }
  }
}

}  // namespace lacon
