// Which matrix an iteration goes on with.
#include "lacon/operators/evolution/newton/matrix_choice.hpp"

#include <gtest/gtest.h>

namespace lacon {
namespace {

MatrixChoice started(const MatrixTraits& traits) {
  MatrixChoice choice(traits);
  choice.start_instant();
  return choice;
}

constexpr NewtonMatrix consistent{.solid = SolidMatrix::tangent, .curved = true};

TEST(MatrixChoice, ATangentMadeSymmetricGoesWithoutStressInContact) {
  for (const bool linear : {false, true})
    for (const bool made_symmetric : {false, true})
      for (const bool touches : {false, true}) {
        const MatrixChoice choice = started({.linear = linear, .made_symmetric = made_symmetric});
        const SolidMatrix expected = !linear && made_symmetric && touches ? SolidMatrix::stressless : SolidMatrix::tangent;
        EXPECT_EQ(choice.suited(SolidMatrix::tangent, touches), (NewtonMatrix{expected, true}))
            << linear << made_symmetric << touches;
        EXPECT_EQ(choice.suited(SolidMatrix::elastic, touches), (NewtonMatrix{SolidMatrix::elastic, true}));
      }
}

TEST(MatrixChoice, WhereTheUserWantsItTheMatrixOfWhatFlowsIsElasticUntilStatusesHaveSettled) {
  for (const bool linear : {false, true}) {
    MatrixChoice choice = started({.linear = linear, .made_symmetric = true, .settling = 2});
    const auto is_elastic = [&] { return choice.suited(SolidMatrix::tangent, true).solid == SolidMatrix::elastic; };
    EXPECT_FALSE(is_elastic());
    choice.note_statuses(3, false);
    EXPECT_FALSE(is_elastic());
    for (const std::int64_t changes : {3, 0, 1, 0}) {
      choice.note_statuses(changes, true);
      EXPECT_EQ(is_elastic(), !linear);  // a stiffness that never changes stays
    }
    choice.note_statuses(0, true);
    EXPECT_FALSE(is_elastic());
  }
}

TEST(MatrixChoice, WithoutContactAnUnstableTangentIsLeftForTheRestOfTheInstant) {
  constexpr NewtonMatrix stressless{.solid = SolidMatrix::stressless, .curved = true};
  MatrixChoice choice = started({});
  EXPECT_FALSE(choice.note_pivots(consistent, false, 3, 3));
  EXPECT_FALSE(choice.note_pivots(stressless, false, 4, 3));  // which has no instability but that of the law
  EXPECT_EQ(choice.suited(SolidMatrix::tangent, false), consistent);
  EXPECT_TRUE(choice.note_pivots(consistent, false, 4, 3));
  EXPECT_EQ(choice.suited(SolidMatrix::tangent, false), stressless);
  EXPECT_FALSE(choice.note_residual({.largest = 1}));
  EXPECT_EQ(choice.suited(SolidMatrix::tangent, false), stressless);
  choice.start_instant();
  EXPECT_EQ(choice.suited(SolidMatrix::tangent, false), consistent);
}

TEST(MatrixChoice, InContactStressAndCurvatureAreLeftOutTogetherEachTimeForTwiceAsLong) {
  for (const bool linear : {false, true}) {
    // a linear stiffness has no terms of stress
    const NewtonMatrix flat{.solid = linear ? SolidMatrix::tangent : SolidMatrix::stressless, .curved = false};
    MatrixChoice choice = started({.linear = linear});
    EXPECT_FALSE(choice.note_pivots(consistent, true, 3, 3));
    EXPECT_FALSE(choice.leaves_unstable());
    EXPECT_TRUE(choice.note_pivots(consistent, true, 4, 3));  // for one iteration
    EXPECT_EQ(choice.suited(SolidMatrix::tangent, false), flat);
    EXPECT_FALSE(choice.note_pivots(flat, true, 4, 3));  // there is nothing left to leave out
    EXPECT_TRUE(choice.note_residual({.largest = 1}));
    EXPECT_TRUE(choice.leaves_unstable());  // the one that there was
    choice.note_residual({.largest = 1});
    EXPECT_FALSE(choice.leaves_unstable());
    EXPECT_EQ(choice.suited(SolidMatrix::tangent, false), consistent);
    EXPECT_TRUE(choice.note_pivots(consistent, true, 4, 3));  // for two
    EXPECT_FALSE(choice.note_residual({.largest = 1}));
    EXPECT_EQ(choice.suited(SolidMatrix::tangent, false), flat);
    EXPECT_TRUE(choice.note_residual({.largest = 1}));
    EXPECT_EQ(choice.suited(SolidMatrix::tangent, false), consistent);
  }
}

TEST(MatrixChoice, AnUnstableEquilibriumThatIterationsComeToSlowlyHasItsOwnMatrix) {
  const auto unstable = [](MatrixChoice& choice) {
    return choice.suited(SolidMatrix::tangent, true).curved && choice.note_pivots(consistent, true, 4, 3);
  };
  for (const double ratio : {0.3, 1.2, 0.1}) {  // go away, and come quickly enough
    for (const bool statuses_change : {false, true}) {
      for (const double share : {5e-3, 0.1}) {
        MatrixChoice choice = started({});
        double residual = 1;
        int left_out = 0;
        for (int iteration = 0; iteration < 9; ++iteration) {
          left_out += unstable(choice) || !choice.suited(SolidMatrix::tangent, true).curved;
          residual *= ratio;
          choice.note_residual({.largest = residual, .share = share, .statuses_change = statuses_change, .curved = true});
        }
        const bool expected = ratio == 0.3 && !statuses_change && share < 0.01;
        EXPECT_EQ(left_out, expected ? 4 : 9) << ratio << statuses_change << share;
        EXPECT_EQ(choice.suited(SolidMatrix::tangent, true) == consistent, expected);
        if (!expected) continue;
        EXPECT_FALSE(unstable(choice));
        choice.note_residual({.largest = 0.9 * residual, .share = share, .curved = true});
        EXPECT_FALSE(unstable(choice));
        choice.note_residual({.largest = residual, .share = share, .curved = true});  // that led away
        EXPECT_TRUE(unstable(choice));
        choice.note_residual({.largest = residual, .share = share, .curved = true});
        EXPECT_FALSE(choice.suited(SolidMatrix::tangent, true).curved);  // three of these have to be slow again
      }
    }
  }
}

TEST(MatrixChoice, AnInstantThatFollowsAnUnstableEquilibriumTakesTheMatrixAsItIs) {
  MatrixChoice choice = started({});
  choice.start_instant(true);
  EXPECT_TRUE(choice.follows_unstable());
  for (int i = 0; i < 3; ++i) {
    EXPECT_FALSE(choice.note_pivots(consistent, true, 4, 3));
    EXPECT_FALSE(choice.note_residual({.largest = 1, .share = 0.001, .curved = true}));
    EXPECT_EQ(choice.suited(SolidMatrix::tangent, true), consistent);
  }
  choice.start_instant();  // that one alone
  EXPECT_FALSE(choice.follows_unstable());
  EXPECT_TRUE(choice.note_pivots(consistent, true, 4, 3));
}

TEST(MatrixChoice, ATangentThatIsNotSymmetricIsTakenAsItIs) {
  for (const bool touches : {false, true}) {
    const MatrixChoice choice = started({.made_symmetric = true, .symmetric = false});
    EXPECT_EQ(choice.suited(SolidMatrix::tangent, touches), (NewtonMatrix{SolidMatrix::whole, true}));
    EXPECT_EQ(choice.suited(SolidMatrix::elastic, touches), (NewtonMatrix{SolidMatrix::elastic, true}));
  }
}

TEST(MatrixChoice, FarFromBalanceStressAndCurvatureAreLeftOutOfAMatrixWithoutInertia) {
  constexpr NewtonMatrix whole{.solid = SolidMatrix::whole, .curved = true},
      flat{.solid = SolidMatrix::stressless, .curved = false};
  MatrixChoice choice = started({.made_symmetric = true, .symmetric = false});
  EXPECT_FALSE(choice.note_residual({.largest = 9, .share = 0.9}));
  EXPECT_EQ(choice.suited(SolidMatrix::tangent, true), whole);
  EXPECT_TRUE(choice.note_residual({.largest = 11, .share = 1.1}));
  EXPECT_EQ(choice.suited(SolidMatrix::tangent, true), flat);
  EXPECT_FALSE(choice.note_residual({.largest = 12, .share = 1.2}));  // it is that already
  EXPECT_TRUE(choice.note_residual({.largest = 9, .share = 0.9}));
  EXPECT_EQ(choice.suited(SolidMatrix::tangent, true), whole);
  EXPECT_TRUE(choice.note_residual({.largest = 11, .share = 1.1}));
  choice.start_instant();
  EXPECT_EQ(choice.suited(SolidMatrix::tangent, true), whole);
  EXPECT_FALSE(choice.note_residual({.largest = 9, .share = 0.9, .statuses_change = true}));
  EXPECT_TRUE(choice.note_residual({.largest = 8, .share = 0.8, .in_flow = true, .statuses_change = true}));
  EXPECT_EQ(choice.suited(SolidMatrix::tangent, true), flat);
  MatrixChoice symmetric = started({.made_symmetric = true});
  EXPECT_FALSE(symmetric.note_residual({.largest = 11, .share = 1.1}));
}

TEST(MatrixChoice, AResidualThatGrowsInFlowBringsTheElasticMatrixEachTimeForTwiceAsLong) {
  for (const bool symmetric : {true, false}) {
    MatrixChoice choice = started({.made_symmetric = true, .symmetric = symmetric});
    const auto elastic = [&] { return choice.suited(SolidMatrix::tangent, false).solid == SolidMatrix::elastic; };
    EXPECT_FALSE(choice.note_residual({.largest = 5, .in_flow = true}));
    EXPECT_FALSE(choice.note_residual({.largest = 4, .in_flow = true}));
    EXPECT_FALSE(elastic());
    EXPECT_TRUE(choice.note_residual({.largest = 6, .in_flow = true}));  // for one iteration
    EXPECT_TRUE(elastic());
    EXPECT_FALSE(choice.note_residual({.largest = 3, .in_flow = true}));
    EXPECT_FALSE(elastic());
    EXPECT_TRUE(choice.note_residual({.largest = 7, .in_flow = true}));  // for two
    EXPECT_FALSE(choice.note_residual({.largest = 9, .in_flow = true}));
    EXPECT_TRUE(elastic());
    EXPECT_FALSE(choice.note_residual({.largest = 1, .in_flow = true}));
    EXPECT_FALSE(elastic());
    EXPECT_FALSE(choice.note_residual({.largest = 2}));  // nothing flows: the tangent is elastic as it is
    EXPECT_FALSE(elastic());
  }
}

TEST(MatrixChoice, InSpaceSecondDerivativesOfGapsWaitForAResidualThatFallsSlowlyAtStatusesThatStay) {
  MatrixChoice choice = started({.in_space = true});
  const auto curved = [&] { return choice.suited(SolidMatrix::tangent, true).curved; };
  EXPECT_FALSE(curved());
  EXPECT_EQ(choice.suited(SolidMatrix::tangent, true).solid, SolidMatrix::tangent);
  EXPECT_FALSE(choice.note_residual({.largest = 1, .curved = true}));
  EXPECT_FALSE(choice.note_residual({.largest = 0.04, .curved = true}));
  EXPECT_FALSE(choice.note_residual({.largest = 0.03, .statuses_change = true, .curved = true}));  // a status changed
  EXPECT_FALSE(choice.note_residual({.largest = 0.02, .curved = true}));
  choice.start_instant();
  EXPECT_FALSE(choice.note_residual({.largest = 0.01, .curved = true}));  // nothing before to compare with
  EXPECT_FALSE(curved());
  EXPECT_TRUE(choice.note_residual({.largest = 0.001, .curved = true}));
  EXPECT_TRUE(curved());
  choice.start_instant();
  EXPECT_TRUE(curved());  // from then on
  EXPECT_FALSE(choice.note_residual({.largest = 1, .curved = true}));
  EXPECT_FALSE(choice.note_residual({.largest = 0.9, .curved = true}));
}

// At the end of an instant the consistent matrix is asked once more where another one took its place: not where its pivots
// say nothing.
TEST(MatrixChoice, SaysWhetherTheConsistentMatrixIsWorthAsking) {
  EXPECT_TRUE(MatrixChoice({}).pivots_tell());
  EXPECT_FALSE(MatrixChoice({.made_symmetric = true}).pivots_tell());
  EXPECT_FALSE(MatrixChoice({.symmetric = false}).pivots_tell());
  EXPECT_FALSE(MatrixChoice({.in_space = true}).pivots_tell());
  MatrixChoice choice({});
  choice.start_instant();
  EXPECT_FALSE(choice.has_replaced());
  EXPECT_FALSE(choice.note_pivots(consistent, false, 1, 1));
  EXPECT_FALSE(choice.has_replaced());
  EXPECT_TRUE(choice.note_pivots(consistent, false, 2, 1));
  EXPECT_TRUE(choice.has_replaced());
  choice.start_instant();
  EXPECT_FALSE(choice.has_replaced());
}

}  // namespace
}  // namespace lacon
