// Memory that two processes see.
#include "lacon/assembly/processes/shared_memory.hpp"

#include <gtest/gtest.h>

#include <new>

#include "open_files.hpp"

namespace lacon {
namespace {

TEST(SharedMemory, IsSeenByWhoeverOpensIt) {
  const SharedMemory memory(3 * sizeof(double)), same = SharedMemory::open(memory.path());
  memory.numbers()[2] = 4.5;
  ASSERT_EQ(same.numbers().size(), 3U);
  EXPECT_EQ(same.numbers()[2], 4.5);
  EXPECT_EQ(same.numbers()[0], 0);
}

// Callers take another way where memory ends: it is told as any other memory, and leaves nothing open.
TEST(SharedMemory, SaysThatThereIsNoMemory) {
  const std::ptrdiff_t before = open_files();
  EXPECT_THROW(SharedMemory(std::size_t{1} << 62), std::bad_alloc);
  EXPECT_EQ(open_files(), before);
}

}  // namespace
}  // namespace lacon
