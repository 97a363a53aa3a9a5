#pragma once
// For kernels: the same quantity of LACON_LANES elements as one value that the compiler keeps in vector registers.
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "lacon/elements/plugin.h"

// A kernel that is marked so is compiled for several instruction sets; the loader takes the best one that the processor has, by
// its features: names of processors ("arch=haswell") would leave out all others that have the same. Sanitizers are not ready
// when the loader chooses, and instrumented kernels take minutes to compile as it is.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__) && \
    !defined(__SANITIZE_ADDRESS__)
#define LACON_KERNEL __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#else
#define LACON_KERNEL
#endif

// What a kernel calls is inlined into it, so that it takes the kernel's instruction set: functions, and lambdas (behind their
// parameters).
#define LACON_INLINE [[gnu::always_inline]] inline
#define LACON_INLINE_LAMBDA __attribute__((always_inline))

namespace lacon {

/// One double for each element of a block. Arrays of a batch may start anywhere; arrays of a kernel's own are faster where they
/// start at a cache line: alignas(lane_alignment).
using Lanes = double __attribute__((vector_size(LACON_LANES * sizeof(double)), aligned(sizeof(double)), may_alias));
constexpr std::size_t lane_alignment = 64;

/// What a comparison of Lanes gives: all bits set where it holds.
using LaneMask = decltype(Lanes{} < Lanes{});

/// Item `index` of an array whose fastest index is the lane.
inline const Lanes& lanes(const double* array, std::int64_t index) {
  return *reinterpret_cast<const Lanes*>(array + index * LACON_LANES);
}
inline Lanes& lanes(double* array, std::int64_t index) { return *reinterpret_cast<Lanes*>(array + index * LACON_LANES); }

/// Items `first` to `first + count` of an array, set to zero.
inline void clear_lanes(double* array, std::int64_t first, std::int64_t count) {
  std::memset(array + first * LACON_LANES, 0, static_cast<std::size_t>(count) * LACON_LANES * sizeof(double));
}

/// What went wrong in each lane: the first thing that did.
struct LaneErrors {
  LaneMask code = {};

  LACON_INLINE void set(const LaneMask& wrong, std::int32_t error) {
    code = (code == std::int64_t{LACON_FINE}) & wrong ? LaneMask{} + std::int64_t{error} : code;
  }
  LACON_INLINE void set(int lane, bool wrong, std::int32_t error) {
    if (wrong && code[lane] == LACON_FINE) code[lane] = error;
  }
  /// `values` that are not numbers, or not finite.
  LACON_INLINE void check_finite(const Lanes& values) { set(~(values - values == 0), LACON_NOT_FINITE); }
  LACON_INLINE void store(std::int32_t* error, std::int64_t block) const {
    for (int l = 0; l < LACON_LANES; ++l) error[block * LACON_LANES + l] = static_cast<std::int32_t>(code[l]);
  }
};

/// Say of every element of a batch that the kernel does not serve its kind.
template <class Batch>
void refuse(const Batch& batch) {
  for (std::int64_t i = 0; i < std::int64_t{batch.n_blocks} * LACON_LANES; ++i) batch.error[i] = LACON_BAD_BATCH;
}

}  // namespace lacon
