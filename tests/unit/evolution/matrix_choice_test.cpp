// Which matrix an iteration goes on with.
#include "lacon/operators/evolution/matrix_choice.hpp"

#include <gtest/gtest.h>

namespace lacon {
namespace {

MatrixChoice started(bool linear, bool has_memory) {
  MatrixChoice choice(linear, has_memory);
  choice.start_instant();
  return choice;
}

constexpr NewtonMatrix consistent{.solid = SolidMatrix::tangent, .curved = true};

TEST(MatrixChoice, TheTangentGoesWithoutStressWhereALawWithMemoryTouches) {
  for (const bool linear : {false, true})
    for (const bool memory : {false, true})
      for (const bool touches : {false, true}) {
        const MatrixChoice choice = started(linear, memory);
        const SolidMatrix expected = !linear && memory && touches ? SolidMatrix::stressless : SolidMatrix::tangent;
        EXPECT_EQ(choice.suited(SolidMatrix::tangent, touches), (NewtonMatrix{expected, true})) << linear << memory << touches;
        EXPECT_EQ(choice.suited(SolidMatrix::elastic, touches), (NewtonMatrix{SolidMatrix::elastic, true}));
      }
}

TEST(MatrixChoice, WithoutContactAnUnstableTangentIsLeftForTheRestOfTheInstant) {
  constexpr NewtonMatrix stressless{.solid = SolidMatrix::stressless, .curved = true};
  MatrixChoice choice = started(false, false);
  EXPECT_FALSE(choice.note_pivots(consistent, false, 3, 3));
  EXPECT_FALSE(choice.note_pivots(stressless, false, 4, 3));  // which has no instability but that of the law
  EXPECT_EQ(choice.suited(SolidMatrix::tangent, false), consistent);
  EXPECT_TRUE(choice.note_pivots(consistent, false, 4, 3));
  EXPECT_EQ(choice.suited(SolidMatrix::tangent, false), stressless);
  EXPECT_FALSE(choice.note_residual(1));
  EXPECT_EQ(choice.suited(SolidMatrix::tangent, false), stressless);
  choice.start_instant();
  EXPECT_EQ(choice.suited(SolidMatrix::tangent, false), consistent);
}

TEST(MatrixChoice, InContactStressAndCurvatureAreLeftOutTogetherEachTimeForTwiceAsLong) {
  for (const bool linear : {false, true}) {
    // a linear stiffness has no terms of stress
    const NewtonMatrix flat{.solid = linear ? SolidMatrix::tangent : SolidMatrix::stressless, .curved = false};
    MatrixChoice choice = started(linear, false);
    EXPECT_FALSE(choice.note_pivots(consistent, true, 3, 3));
    EXPECT_TRUE(choice.note_pivots(consistent, true, 4, 3));  // for one iteration
    EXPECT_EQ(choice.suited(SolidMatrix::tangent, false), flat);
    EXPECT_FALSE(choice.note_pivots(flat, true, 4, 3));  // there is nothing left to leave out
    EXPECT_TRUE(choice.note_residual(1));
    EXPECT_EQ(choice.suited(SolidMatrix::tangent, false), consistent);
    EXPECT_TRUE(choice.note_pivots(consistent, true, 4, 3));  // for two
    EXPECT_FALSE(choice.note_residual(1));
    EXPECT_EQ(choice.suited(SolidMatrix::tangent, false), flat);
    EXPECT_TRUE(choice.note_residual(1));
    EXPECT_EQ(choice.suited(SolidMatrix::tangent, false), consistent);
  }
}

TEST(MatrixChoice, AResidualThatGrowsBringsTheElasticMatrixEachTimeForTwiceAsLong) {
  MatrixChoice choice = started(false, true);
  const auto elastic = [&] { return choice.suited(SolidMatrix::tangent, false).solid == SolidMatrix::elastic; };
  EXPECT_FALSE(choice.note_residual(5));
  EXPECT_FALSE(choice.note_residual(4));
  EXPECT_FALSE(elastic());
  EXPECT_TRUE(choice.note_residual(6));  // for one iteration
  EXPECT_TRUE(elastic());
  EXPECT_FALSE(choice.note_residual(3));
  EXPECT_FALSE(elastic());
  EXPECT_TRUE(choice.note_residual(7));  // for two
  EXPECT_FALSE(choice.note_residual(9));
  EXPECT_TRUE(elastic());
  EXPECT_FALSE(choice.note_residual(1));
  EXPECT_FALSE(elastic());
  MatrixChoice without = started(false, false);
  EXPECT_FALSE(without.note_residual(1));
  EXPECT_FALSE(without.note_residual(2));
}

TEST(MatrixChoice, InSpaceSecondDerivativesOfGapsWaitForAResidualThatFallsSlowlyAtStatusesThatStay) {
  MatrixChoice choice(false, false, true);
  choice.start_instant();
  const auto curved = [&] { return choice.suited(SolidMatrix::tangent, true).curved; };
  EXPECT_FALSE(curved());
  EXPECT_EQ(choice.suited(SolidMatrix::tangent, true).solid, SolidMatrix::tangent);
  EXPECT_FALSE(choice.note_residual(1, true));
  EXPECT_FALSE(choice.note_residual(0.04, true));
  EXPECT_FALSE(choice.note_residual(0.03, false));  // a status changed
  EXPECT_FALSE(choice.note_residual(0.02, true));
  choice.start_instant();
  EXPECT_FALSE(choice.note_residual(0.01, true));  // nothing before to compare with
  EXPECT_FALSE(curved());
  EXPECT_TRUE(choice.note_residual(0.001, true));
  EXPECT_TRUE(curved());
  choice.start_instant();
  EXPECT_TRUE(curved());  // from then on
  EXPECT_FALSE(choice.note_residual(1, true));
  EXPECT_FALSE(choice.note_residual(0.9, true));
}

}  // namespace
}  // namespace lacon
