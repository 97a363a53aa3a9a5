#include "lacon/assembly/any_signs.hpp"

#include <cstdint>

namespace lacon {

std::vector<double> any_signs(std::size_t n) {
  std::vector<double> signs(n);
  std::uint32_t state = 1;
  for (double& sign : signs) {
    state = 1664525 * state + 1013904223;
    sign = state >> 31 ? 1 : -1;
  }
  return signs;
}

}  // namespace lacon
