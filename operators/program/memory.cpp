// Large blocks of memory on huge pages where the system has them: a page of 4 kB costs more to get than to fill.
#include <sys/mman.h>

#include <cstddef>
#include <cstdlib>
#include <new>

namespace {

constexpr std::size_t huge_page = std::size_t{1} << 21;
constexpr std::size_t large = 2 * huge_page;  ///< from here on, what rounding up to pages wastes is small

void* allocate(std::size_t size) {
  if (size < large) return std::malloc(size > 0 ? size : 1);
  void* const block = std::aligned_alloc(huge_page, (size + huge_page - 1) / huge_page * huge_page);
  if (block) madvise(block, size / huge_page * huge_page, MADV_HUGEPAGE);  // advice: where it is not taken, nothing is lost
  return block;
}

}  // namespace

void* operator new(std::size_t size) {
  void* block = allocate(size);
  while (!block) {
    const std::new_handler handler = std::get_new_handler();
    if (!handler) throw std::bad_alloc();
    handler();
    block = allocate(size);
  }
  return block;
}

void operator delete(void* block) noexcept { std::free(block); }
void operator delete(void* block, std::size_t) noexcept { std::free(block); }
