#include "stereovox/occupancy/log_odds_rule.h"

#include <gtest/gtest.h>

#include <cmath>

namespace stereovox {
namespace {

double log_odds(double probability) { return std::log(probability / (1.0 - probability)); }

VoxelBelief after_many(const LogOddsRule& rule, float observation) {
  VoxelBelief belief = kNoBelief;
  for (int i = 0; i < 100; ++i) belief = rule.after(belief, observation);
  return belief;
}

// Observations of one kind until the voxel lies on the other side of 0.5.
int observations_to_change(const LogOddsRule& rule, VoxelBelief belief, float observation) {
  const bool was_occupied = belief.state > 0.5;
  int count = 0;
  for (; count < 100 && (belief.state > 0.5) == was_occupied; ++count)
    belief = rule.after(belief, observation);
  return count;
}

TEST(LogOddsRule, AHitAddsAndAMissSubtractsAConstant) {
  const LogOddsRule rule;
  EXPECT_NEAR(log_odds(rule.after(kNoBelief, 1.0F).state), std::log(0.7 / 0.3), 1e-12);
  EXPECT_NEAR(log_odds(rule.after({.state = 0.8}, 0.0F).state), log_odds(0.8) + std::log(0.4 / 0.6),
              1e-12);
  EXPECT_EQ(rule.after(kNoBelief, 0.6F).state, rule.after(kNoBelief, 1.0F).state);
}

TEST(LogOddsRule, IsClampedToTwoAndThreeAndAHalf) {
  const LogOddsRule rule;
  EXPECT_NEAR(log_odds(after_many(rule, 0.0F).state), -2.0, 1e-3);
  EXPECT_NEAR(log_odds(after_many(rule, 1.0F).state), 3.5, 0.02);
}

TEST(LogOddsRule, ThreeHitsOrNineMissesChangeItsMind) {
  const LogOddsRule rule;
  EXPECT_EQ(observations_to_change(rule, after_many(rule, 0.0F), 1.0F), 3);
  EXPECT_EQ(observations_to_change(rule, after_many(rule, 1.0F), 0.0F), 9);
}

TEST(LogOddsRule, AFaintSurfaceIsNeitherHitNorMiss) {
  EXPECT_EQ(LogOddsRule{}.after({.state = 0.3}, 0.1F).state, 0.3);
  EXPECT_GT(LogOddsRule{.min_hit_evidence = 0.05}.after({.state = 0.3}, 0.1F).state, 0.3);
}

}  // namespace
}  // namespace stereovox
