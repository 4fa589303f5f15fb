#include "stereovox/evaluation/relative_pose_error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace stereovox {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

std::vector<SE3> poses_at_x(const std::vector<double>& x_m) {
  std::vector<SE3> poses;
  for (const double x : x_m) poses.push_back({.translation = {x, 0.0, 0.0}});
  return poses;
}

TEST(RelativePoseError, IsWhatTheEstimatedMotionAddsToTheTrueOne) {
  const Eigen::Quaterniond left(Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitZ()));
  const SE3 error{left, {0.1, 0.2, 0.3}};
  const SE3 true_motion{left, {1.0, 0.0, 0.0}};
  const SE3 start{left, {5.0, 6.0, 7.0}};
  const PosePairs pairs{{{}, true_motion}, {start, start * true_motion * error}};
  const SE3 found = relative_pose_error(pairs, 0, 1);
  EXPECT_TRUE(found.translation.isApprox(error.translation, 1e-12));
  EXPECT_NEAR(found.rotation.angularDistance(error.rotation), 0.0, 1e-7);
}

TEST(RelativePoseError, FramePairsFollowEachOtherOrStartEverywhere) {
  EXPECT_THAT(pairs_by_frames(6, 2.0, false), ElementsAre(Pair(0, 2), Pair(2, 4)));
  EXPECT_THAT(pairs_by_frames(4, 2.0, true), ElementsAre(Pair(0, 2), Pair(1, 3)));
  EXPECT_THAT(pairs_by_frames(2, 2.0, false), IsEmpty());
}

TEST(RelativePoseError, PathPairsStartWhereTheWayFirstReachesTheLength) {
  const auto poses = poses_at_x({0.0, 0.6, 1.2, 1.8, 2.4, 3.4});
  EXPECT_THAT(pairs_by_path(poses, 1.0, false), ElementsAre(Pair(2, 4), Pair(4, 5)));
}

TEST(RelativePoseError, AllPathPairsTakeTheNearestWithinATenthOfTheLength) {
  const auto poses = poses_at_x({0.0, 0.5, 1.05, 1.3, 2.0});
  EXPECT_THAT(pairs_by_path(poses, 1.0, true), ElementsAre(Pair(0, 2), Pair(2, 4)));
}

TEST(RelativePoseError, TheWayCountsTurningBack) {
  EXPECT_THAT(way_along(poses_at_x({0.0, 2.0, 1.0})), ElementsAre(0.0, 2.0, 3.0));
  EXPECT_THAT(pairs_by_path({}, 1.0, true), IsEmpty());
}

}  // namespace
}  // namespace stereovox
