#include "lacon/structures/openblas.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <new>
#include <string>
#include <vector>

#include "lacon/structures/parallel.hpp"

namespace lacon {

void reserve_blas_memory() {
  void* (*const take)(int) = openblas<void*(int)>("blas_memory_alloc");
  void (*const give_back)(void*) = openblas<void(void*)>("blas_memory_free");  // it stays OpenBLAS's, for its next product
  if (!take || !give_back) return;
  constexpr std::size_t more_than_it_takes = std::size_t{160} << 20;
  constexpr std::size_t most = 16;  // threads: OpenBLAS has places for a few dozen
  const std::size_t wanted = std::min(n_threads(), most);
  std::vector<void*> taken;
  while (taken.size() < wanted) {
    void* const probe = std::malloc(more_than_it_takes);
    if (!probe) break;
    std::free(probe);
    taken.push_back(take(0));
  }
  for (void* const memory : taken) give_back(memory);
  if (taken.empty()) throw std::bad_alloc();
  if (taken.size() < wanted) setenv("LACON_THREADS", std::to_string(taken.size()).c_str(), 1);
}

}  // namespace lacon
