#pragma once
// Loops over the nodes of a cell, or over the axes of a point, whose length the compiler knows.
#include <cstddef>
#include <utility>

namespace lacon {

/// Call `work` with `size`, as a std::integral_constant where it is the number of nodes of a linear cell or of axes: large
/// meshes are made of these, and what is done to a row is then a few instructions without a loop.
template <class Work>
[[gnu::always_inline]] inline void with_known_size(std::size_t size, const Work& work) {
  const auto known = [&]<std::size_t... common>(std::index_sequence<common...>) __attribute__((always_inline)) {
    return ((size == common && (work(std::integral_constant<std::size_t, common>{}), true)) || ...);
  };
  if (!known(std::index_sequence<2, 3, 4, 5, 6, 8>{})) work(size);
}

}  // namespace lacon
