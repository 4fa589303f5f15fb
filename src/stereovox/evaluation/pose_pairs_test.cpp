#include "stereovox/evaluation/pose_pairs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stereovox/core/error.h"
#include "stereovox/core/timestamp.h"

namespace stereovox {
namespace {

// Poses at the given seconds; their x coordinate tells which they are.
Trajectory at_seconds(const std::vector<double>& stamps_s) {
  Trajectory trajectory;
  for (const double stamp_s : stamps_s)
    trajectory.push_back({ns_from_seconds(stamp_s), {.translation = {stamp_s, 0.0, 0.0}}});
  return trajectory;
}

std::vector<double> x_of(const std::vector<SE3>& poses) {
  std::vector<double> x;
  for (const SE3& pose : poses) x.push_back(pose.translation.x());
  return x;
}

TEST(PosePairs, EachPoseOfTheShorterTrajectoryTakesTheNearestOfTheLonger) {
  const PosePairs pairs =
      match_by_stamp(at_seconds({0, 0.5, 1, 1.5, 2}), at_seconds({0.004, 0.996, 2.02}), 0.01);
  EXPECT_THAT(x_of(pairs.truth), testing::ElementsAre(0.0, 1.0));
  EXPECT_THAT(x_of(pairs.estimate), testing::ElementsAre(0.004, 0.996));
  EXPECT_EQ(pairs.unmatched_truth, 3);
  EXPECT_EQ(pairs.unmatched_estimate, 1);
}

TEST(PosePairs, TheTruthMayBeTheShorterOne) {
  const PosePairs pairs = match_by_stamp(at_seconds({1}), at_seconds({0, 1.001, 2}), 0.01);
  EXPECT_THAT(x_of(pairs.truth), testing::ElementsAre(1.0));
  EXPECT_THAT(x_of(pairs.estimate), testing::ElementsAre(1.001));
}

TEST(PosePairs, APoseClaimedTwiceStaysWithTheNearerClaim) {
  const PosePairs pairs =
      match_by_stamp(at_seconds({1.0, 5.0, 6.0}), at_seconds({0.992, 1.001, 1.009}), 0.01);
  EXPECT_THAT(x_of(pairs.truth), testing::ElementsAre(1.0));
  EXPECT_THAT(x_of(pairs.estimate), testing::ElementsAre(1.001));
}

// The estimate would find two partners here; the truth, which is shorter, asks for one twice.
TEST(PosePairs, TheShorterTrajectoryChooses) {
  const PosePairs pairs =
      match_by_stamp(at_seconds({1.0, 1.006}), at_seconds({0.995, 1.004, 9}), 0.01);
  EXPECT_THAT(x_of(pairs.truth), testing::ElementsAre(1.006));
  EXPECT_THAT(x_of(pairs.estimate), testing::ElementsAre(1.004));
}

std::string complaint_of(const Trajectory& truth, const Trajectory& estimate) {
  try {
    match_by_stamp(truth, estimate, 0.01);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(PosePairs, NoOverlapInTimeIsAnErrorThatTellsBothSpans) {
  EXPECT_EQ(complaint_of(at_seconds({0, 10}), at_seconds({100, 110})),
            "trajectories: no matching time stamps within 0.01 s (truth 0 .. 10 s, estimate 100 .. "
            "110 s)");
  EXPECT_EQ(complaint_of({}, at_seconds({1})), "trajectories: the truth has no poses");
  EXPECT_EQ(complaint_of(at_seconds({1}), {}), "trajectories: the estimate has no poses");
}

TEST(PosePairs, WithoutTimeStampsTheCountsMustBeEqual) {
  const std::vector<SE3> two(2), three(3);
  EXPECT_EQ(match_by_index(two, two).size(), 2U);
  EXPECT_THROW(match_by_index(two, three), Error);
}

}  // namespace
}  // namespace stereovox
