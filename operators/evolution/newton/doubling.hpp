#pragma once
// How often what has failed is left alone before it is tried again.
#include <cstdint>

namespace lacon {

/// Turns (iterations, instants) that something lasts: twice as many each time that they were not enough.
struct Doubling {
  std::int64_t left = 0;  ///< that still last
  std::int64_t next = 1;  ///< how many begin with the next time
  void begin() {
    left = next;
    next *= 2;
  }
};

}  // namespace lacon
