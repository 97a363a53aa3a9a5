#pragma once
#include <gtest/gtest.h>

#include <cstdlib>

#include "lacon/pairing/pairing.hpp"

namespace lacon::test {

/// What some threads find has the bits of what one finds. @param pair_again the same pairing
template <class PairAgain>
void expect_same_in_threads(const Pairing& alone, const PairAgain& pair_again) {
  for (const char* threads : {"2", "3", "5"}) {
    setenv("LACON_THREADS", threads, 1);
    const Pairing found = pair_again();
    unsetenv("LACON_THREADS");
    EXPECT_TRUE(found.cells == alone.cells) << threads;
    EXPECT_EQ(found.rejected, alone.rejected) << threads;
  }
}

}  // namespace lacon::test
