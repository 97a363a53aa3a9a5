#pragma once
// How many files this process has open.
#include <cstddef>
#include <filesystem>
#include <iterator>

namespace lacon {

inline std::ptrdiff_t open_files() {
  return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), std::filesystem::directory_iterator());
}

}  // namespace lacon
