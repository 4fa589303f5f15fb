#include "stereovox/occupancy/dempster_shafer_rule.h"

#include <gtest/gtest.h>

namespace stereovox {
namespace {

void expect_masses(const Masses& masses, double occupied, double free, double unknown) {
  EXPECT_NEAR(masses.occupied, occupied, 1e-12);
  EXPECT_NEAR(masses.free, free, 1e-12);
  EXPECT_NEAR(masses.unknown, unknown, 1e-12);
}

VoxelBelief after_many(const DempsterShaferRule& rule, VoxelBelief belief, float observation,
                       int times = 100) {
  for (int i = 0; i < times; ++i) belief = rule.after(belief, observation);
  return belief;
}

TEST(DempsterShafer, AgreeingEvidenceLeavesTheProductOfTheIgnorances) {
  expect_masses(combine({0.6, 0.0, 0.4}, {0.5, 0.0, 0.5}, ConflictRule::dempster), 0.8, 0.0, 0.2);
}

// (0.6, 0, 0.4) and (0, 0.3, 0.7): the conflict is 0.18.
TEST(DempsterShafer, ConflictIsSharedOutOrBecomesIgnorance) {
  const Masses hit{0.6, 0.0, 0.4}, crossed{0.0, 0.3, 0.7};
  expect_masses(combine(hit, crossed, ConflictRule::dempster), 0.42 / 0.82, 0.12 / 0.82,
                0.28 / 0.82);
  expect_masses(combine(hit, crossed, ConflictRule::yager), 0.42, 0.12, 0.46);
}

TEST(DempsterShaferRule, TheStateIsThePignisticValue) {
  const VoxelBelief hit = DempsterShaferRule{}.after(kNoBelief, 1.0F);
  EXPECT_NEAR(hit.ignorance, 0.4, 1e-12);
  EXPECT_NEAR(hit.state, 0.6 + 0.2, 1e-12);
  const VoxelBelief crossed = DempsterShaferRule{}.after(kNoBelief, 0.0F);
  EXPECT_NEAR(crossed.ignorance, 0.7, 1e-12);
  EXPECT_NEAR(crossed.state, 0.35, 1e-12);
}

TEST(DempsterShaferRule, AFaintHitLeavesMoreUnknown) {
  const VoxelBelief faint = DempsterShaferRule{}.after(kNoBelief, 0.5F);
  EXPECT_NEAR(faint.ignorance, 0.7, 1e-12);
  EXPECT_NEAR(faint.state, 0.3 + 0.35, 1e-12);
}

TEST(DempsterShaferRule, SeenBothWaysIsNotTheSameAsNeverSeen) {
  const DempsterShaferRule rule;
  VoxelBelief belief = kNoBelief;
  for (int i = 0; i < 2; ++i) belief = after_many(rule, rule.after(belief, 1.0F), 0.0F, 2);
  EXPECT_NEAR(belief.state, 0.5, 0.2);
  EXPECT_LT(belief.ignorance, 0.2);
}

TEST(DempsterShaferRule, NoVoxelIsBeyondPersuasion) {
  for (const ConflictRule conflict : {ConflictRule::dempster, ConflictRule::yager}) {
    const DempsterShaferRule rule{.conflict = conflict};
    const VoxelBelief free = after_many(rule, kNoBelief, 0.0F);
    EXPECT_LT(free.state, 0.05);
    EXPECT_GE(free.ignorance, rule.min_ignorance);
    EXPECT_GT(after_many(rule, free, 1.0F, 6).state, 0.5);
  }
}

TEST(DempsterShaferRule, TakesOverAVoxelOfAnotherRule) {
  const VoxelBelief taken = DempsterShaferRule{}.after({.state = 1.0, .ignorance = 0.0}, 0.0F);
  EXPECT_GT(taken.state, 0.5);
  EXPECT_LT(taken.state, 1.0);
}

}  // namespace
}  // namespace stereovox
