// The main function of unit tests: 77, which ctest shows as skipped, where none has failed and some have been.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

int main(int argc, char** argv) {
  testing::InitGoogleMock(&argc, argv);
  if (RUN_ALL_TESTS() != 0) return 1;
  constexpr int skipped = 77;
  return testing::UnitTest::GetInstance()->skipped_test_count() > 0 ? skipped : 0;
}
