#include "stereovox/core/trajectory.h"

#include <gtest/gtest.h>

namespace stereovox {
namespace {

SE3 at_x(double x) { return {Eigen::Quaterniond::Identity(), {x, 0, 0}}; }

const Trajectory kTrajectory = {{100, at_x(0)}, {200, at_x(1)}, {900, at_x(4)}};

double x_at(std::int64_t stamp_ns) {
  const auto pose = pose_at(kTrajectory, stamp_ns, 5, 300);
  return pose ? pose->translation.x() : -1.0;
}

TEST(Trajectory, PoseAtTakesTheNearestEntryOrInterpolatesOverSmallGaps) {
  EXPECT_EQ(x_at(97), 0.0);
  EXPECT_EQ(x_at(203), 1.0);
  EXPECT_NEAR(x_at(150), 0.5, 1e-12);
  EXPECT_EQ(x_at(500), -1.0) << "the gap of 700 ns is too wide";
  EXPECT_EQ(x_at(90), -1.0) << "before the first entry";
  EXPECT_EQ(x_at(1000), -1.0) << "after the last entry";
}

TEST(Trajectory, PathLengthAddsTheSteps) { EXPECT_NEAR(path_length_m(kTrajectory), 4.0, 1e-12); }

}  // namespace
}  // namespace stereovox
