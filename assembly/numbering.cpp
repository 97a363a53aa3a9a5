#include "lacon/assembly/numbering.hpp"

#include "lacon/assembly/counts.hpp"

namespace lacon {

Numbering number_equations(std::int64_t n_nodes, int n_components, std::span<const std::uint8_t> free, std::int64_t n_patches) {
  Numbering numbering{.n_nodes = n_nodes, .n_components = n_components, .first = {0}, .equation = {}};
  numbering.equation.assign(free.size(), -1);
  std::int64_t next = 0;
  for (std::int64_t node = 0; node < n_nodes; ++node) {
    for (std::int64_t dof = node * n_components; dof < (node + 1) * n_components; ++dof)
      if (free[dof]) numbering.equation[dof] = next++;
    numbering.first.push_back(next);
  }
  for (std::int64_t patch = 0; patch < n_patches; ++patch) numbering.first.push_back(++next);
  narrow_count(next, "counted_equations");  // rows and columns of matrices are of 32 bits
  return numbering;
}

}  // namespace lacon
