#include "stereovox/occupancy/voxel_evidence.h"

#include <gtest/gtest.h>

namespace stereovox {
namespace {

VoxelEvidence evidence_of(std::initializer_list<float> points) {
  VoxelEvidence evidence;
  for (const float point : points) evidence.add(point, true, true);
  return evidence;
}

TEST(VoxelEvidence, MaxLetsOnePointDecide) {
  EXPECT_FLOAT_EQ(float(MaxUnion{}.strength(evidence_of({0.1F, 0.93F, 0.2F}), 100.0)), 0.93F);
}

TEST(VoxelEvidence, RankAsksForAShareOfThePointsThatAFaceSends) {
  const VoxelEvidence evidence = evidence_of({1.0F, 15.0F / 31, 10.0F / 31});
  const auto strength = [&](double expected) {
    return RankUnion{0.05}.strength(evidence, expected);
  };
  EXPECT_DOUBLE_EQ(strength(1.0), 1.0);
  EXPECT_DOUBLE_EQ(strength(20.0), 1.0);
  EXPECT_DOUBLE_EQ(strength(20.1), 15.0 / 31);
  EXPECT_DOUBLE_EQ(strength(60.0), 10.0 / 31);
  EXPECT_DOUBLE_EQ(strength(60.1), 0.0);  // fewer points than needed
}

TEST(VoxelEvidence, MajorityAsksForAShareOfThePointsNearby) {
  // Two points inside, four just behind the voxel.
  const VoxelEvidence evidence =
      evidence_of({1.0F, 1.0F, 10.0F / 31, 10.0F / 31, 10.0F / 31, 10.0F / 31, 0.0F});
  const auto strength = [&](double majority) {
    return RankUnion{.quantile = 0.0, .majority = majority}.strength(evidence, 1.0);
  };
  EXPECT_DOUBLE_EQ(strength(0.0), 1.0);
  EXPECT_DOUBLE_EQ(strength(2.0 / 6), 1.0);
  EXPECT_DOUBLE_EQ(strength(0.5), 10.0 / 31);
}

TEST(VoxelEvidence, PointsThatAreNotExactHaveNoVoteInTheMajority) {
  VoxelEvidence evidence;
  evidence.add(1.0F, true, true);
  for (int i = 0; i < 9; ++i) evidence.add(0.3F, false, false);
  EXPECT_DOUBLE_EQ((RankUnion{.quantile = 0.0, .majority = 0.5}.strength(evidence, 1.0)), 1.0);
}

TEST(VoxelEvidence, PrintedDensityAddsTheSameForEachPointAtEveryVoxelSize) {
  EXPECT_NEAR(PrintedDensity{}.bonus(evidence_of({0, 0, 0}), 0.0), 0.03, 1e-12);
}

TEST(VoxelEvidence, RelativeDensityAddsAtMostLambda) {
  const RelativeDensity density{.lambda = 0.1};
  EXPECT_DOUBLE_EQ(density.bonus(evidence_of({0, 0}), 4.0), 0.05);
  EXPECT_DOUBLE_EQ(density.bonus(evidence_of({0, 0}), 1.0), 0.1);
}

TEST(VoxelEvidence, ObservationIsAtMostOne) {
  EXPECT_EQ(observation_of(evidence_of({1.0F}), 1.0, MaxUnion{}, RelativeDensity{}), 1.0F);
}

}  // namespace
}  // namespace stereovox
