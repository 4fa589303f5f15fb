#include "stereovox/occupancy/visibility_rule.h"

#include <gtest/gtest.h>

namespace stereovox {
namespace {

TEST(VisibilityRule, HitsAndMissesOfAVoxelAtOneHalfAreThoseOfTheMethod) {
  const VisibilityRule rule;
  const struct {
    double visibility, after_hit, after_miss;
  } rows[] = {{1.0, 0.56122, 0.44118}, {0.5, 0.55556, 0.47945}, {0.1, 0.53191, 0.49669}};
  for (const auto& row : rows) {
    EXPECT_NEAR(rule.after(kNoBelief, 1.0F, row.visibility).state, row.after_hit, 5e-6);
    EXPECT_NEAR(rule.after(kNoBelief, 0.0F, row.visibility).state, row.after_miss, 5e-6);
  }
}

TEST(VisibilityRule, AnInvisibleVoxelLearnsNothing) {
  EXPECT_DOUBLE_EQ(VisibilityRule{}.after({.state = 0.3}, 1.0F, 0.0).state, 0.3);
}

TEST(VisibilityRule, AHitOfHalfTheEvidenceLiesBetweenHitAndMiss) {
  const VisibilityRule rule;
  const double half = rule.after(kNoBelief, 0.5F, 1.0).state;
  EXPECT_LT(half, rule.after(kNoBelief, 1.0F, 1.0).state);
  EXPECT_GT(half, rule.after(kNoBelief, 0.0F, 1.0).state);
  EXPECT_NEAR(half, 0.5, 0.02);
}

TEST(VisibilityRule, WhatIsHiddenIsLessVisibleAndWhatIsNearlyVisibleIsVisible) {
  const VisibilityRule rule;
  EXPECT_DOUBLE_EQ(rule.visibility(1.0, 1.0), 0.2);
  EXPECT_DOUBLE_EQ(rule.visibility(0.5, 1.0), 0.1);
  EXPECT_DOUBLE_EQ(rule.visibility(1.0, 0.3), 1.0);
  EXPECT_DOUBLE_EQ(rule.visibility(0.6, 0.0), 0.6);
}

TEST(VisibilityRule, AVoxelAsFreeAsCanBeHidesNothing) {
  const VisibilityRule rule;
  const float freest = static_cast<float>(rule.limits.min_probability);
  EXPECT_EQ(rule.occupancy({.state = freest, .observations = 9}), 0.0);
  EXPECT_EQ(rule.occupancy({.state = 0.25F, .observations = 9}), 0.25);
  EXPECT_EQ(rule.occupancy(Voxel{}), rule.unknown_occupancy);
}

}  // namespace
}  // namespace stereovox
