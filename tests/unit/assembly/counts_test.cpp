// Counts that have to be numbers of 32 bits.
#include "lacon/assembly/counts.hpp"

#include <gtest/gtest.h>

namespace lacon {
namespace {

TEST(Counts, AreToldWhereTheyAreTooMany) {
  constexpr std::int64_t most = std::numeric_limits<std::int32_t>::max();
  EXPECT_EQ(narrow_count(most, "counted_equations"), most);
  try {
    narrow_count(most + 1, "counted_equations");
    FAIL() << "a count that wraps round";
  } catch (const Error& error) {
    EXPECT_EQ(error.message().id, "SOLVER_16");
    EXPECT_NE(error.message().text.find("2147483648"), std::string::npos) << error.message().text;
  }
  EXPECT_EQ(narrow_count<std::int64_t>(most + 1, "counted_equations"), most + 1);
}

}  // namespace
}  // namespace lacon
