#pragma once
// OpenBLAS as it is found in this program: rooms name no function of it, for not every program is linked with it.
#include <dlfcn.h>

namespace lacon {

/// A function of OpenBLAS; null where it is not linked.
template <class Function>
Function* openblas(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_DEFAULT, name));
}

/// Have OpenBLAS take the memory that its products work in, for each thread (128 MB of addresses, of which what is used becomes
/// real). Where there is none a thread would try for ever at its first large product: std::bad_alloc instead, and fewer threads
/// where there is less. Nothing where OpenBLAS is not linked.
void reserve_blas_memory();

}  // namespace lacon
