#pragma once
// Large arrays and the pages that the system gives for them.
#include <sys/mman.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lacon {

/// Reserve `capacity` values, with memory behind the first `size`, which are about to be written: asked for in one call, the
/// pages of a large array cost a sixth less than one by one, as each is touched first. What lies behind costs nothing until
/// then.
template <class T>
void reserve_pages(std::vector<T>& values, std::size_t size, std::size_t capacity) {
  values.reserve(capacity);
#ifdef MADV_POPULATE_WRITE
  constexpr std::uintptr_t page = 4096, large = 1 << 20;
  const auto first = (reinterpret_cast<std::uintptr_t>(values.data() + values.size()) + page - 1) / page * page,
             end = reinterpret_cast<std::uintptr_t>(values.data() + size) / page * page;
  // a system that cannot (Linux before 5.14, or other pages) gives them one by one
  if (end > first + large) madvise(reinterpret_cast<void*>(first), end - first, MADV_POPULATE_WRITE);
#endif
}

}  // namespace lacon
