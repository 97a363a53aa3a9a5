#pragma once
// What lies in memory in single or double precision, in vector registers of double precision: for kernels.
#include <cstring>

#include "lacon/elements/lanes.hpp"

namespace lacon {

using FourDoubles = double __attribute__((vector_size(32)));
using EightDoubles = double __attribute__((vector_size(64)));

LACON_INLINE void load(const double* from, FourDoubles& to) { std::memcpy(&to, from, sizeof to); }
// Element by element, which compilers make one instruction of: __builtin_convertvector of gcc 12 becomes five.
LACON_INLINE void load(const float* from, FourDoubles& to) {
  float __attribute__((vector_size(16))) f;
  std::memcpy(&f, from, sizeof f);
  to = FourDoubles{f[0], f[1], f[2], f[3]};
}
LACON_INLINE void load(const float* from, EightDoubles& to) {
  float __attribute__((vector_size(32))) f;
  std::memcpy(&f, from, sizeof f);
  to = EightDoubles{f[0], f[1], f[2], f[3], f[4], f[5], f[6], f[7]};
}

}  // namespace lacon
