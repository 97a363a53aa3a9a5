// Where a computation is, in words: share of the list, time, and the line as a whole.
#include "lacon/operators/evolution/observers/progress.hpp"

#include <gtest/gtest.h>

namespace lacon {
namespace {

// Each interval of the list counts the same, however long it is; a step that was cut ends within one.
TEST(Progress, SharesCountIntervals) {
  const std::vector<double> list{0, 1, 11, 12};
  EXPECT_DOUBLE_EQ(share_of_list(list, 0), 0);
  EXPECT_DOUBLE_EQ(share_of_list(list, 1), 1.0 / 3);
  EXPECT_DOUBLE_EQ(share_of_list(list, 6), 0.5);
  EXPECT_DOUBLE_EQ(share_of_list(list, 12), 1);
  EXPECT_DOUBLE_EQ(share_of_list(list, -1), 0);
  EXPECT_DOUBLE_EQ(share_of_list({5}, 5), 1);
}

TEST(Progress, TimesHaveTwoUnits) {
  EXPECT_EQ(in_words(0.4), "0 s");
  EXPECT_EQ(in_words(59.4), "59 s");
  EXPECT_EQ(in_words(80), "1 min 20 s");
  EXPECT_EQ(in_words(7380), "2 h 3 min");
}

// One hundred per cent are those of a list that is at its end; what remains is said where it is known.
TEST(Progress, TheLineSaysInstantIterationPhaseShareAndTime) {
  EXPECT_EQ(progress_text(0.35, 4, "pairing", 0.999, 80, {}),
            "INST 0.35  iteration 4  pairing          99 % of the instants  1 min 20 s");
  EXPECT_EQ(progress_text(2, 0, "linear system", 0.25, 10, 30),
            "INST 2  iteration 0  linear system    25 % of the instants  10 s, about 30 s left");
}

}  // namespace
}  // namespace lacon
