#include "stereovox/evaluation/trajectory_score.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "stereovox/core/error.h"
#include "stereovox/core/timestamp.h"

namespace stereovox {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

SE3 turned(double yaw_rad, const Eigen::Vector3d& position) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ())), position};
}

Trajectory trajectory_of(const std::vector<SE3>& poses) {
  Trajectory trajectory;
  for (const SE3& pose : poses)
    trajectory.push_back(
        {static_cast<std::int64_t>(trajectory.size()) * kNanosecondsPerSecond, pose});
  return trajectory;
}

// Straight along x, one metre a frame.
std::vector<SE3> straight(int frames, double metres_per_frame = 1.0) {
  std::vector<SE3> poses;
  for (int i = 0; i < frames; ++i) poses.push_back(turned(0.0, {i * metres_per_frame, 0.0, 0.0}));
  return poses;
}

std::vector<SE3> wandering(int frames, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, 0.1);
  std::vector<SE3> poses = {SE3{}};
  while (static_cast<int>(poses.size()) < frames) {
    Vector6d twist;
    for (int k = 0; k < 6; ++k) twist[k] = noise(random);
    twist[0] += 0.5;
    poses.push_back(poses.back() * exp(twist));
  }
  return poses;
}

std::vector<SE3> moved(const SE3& T, std::vector<SE3> poses) {
  for (SE3& pose : poses) pose = T * pose;
  return poses;
}

TrajectoryScore score(const std::vector<SE3>& truth, const std::vector<SE3>& estimate,
                      const TrajectoryScoreParams& params = {}) {
  return score_trajectory(trajectory_of(truth), trajectory_of(estimate), params);
}

const SE3 kElsewhere = turned(2.0, {10.0, -20.0, 3.0});

TEST(TrajectoryScore, OfThePerfectEstimateIsZero) {
  const auto poses = wandering(50, 1);
  const TrajectoryScore s = score(poses, moved(kElsewhere, poses));
  EXPECT_NEAR(s.ate_m.max, 0.0, 1e-12);
  EXPECT_NEAR(s.rpe_translation_m.max, 0.0, 1e-12);
  EXPECT_NEAR(s.rpe_rotation_deg.max, 0.0, 1e-5);
  EXPECT_NEAR(s.segments_overall.t_rel_percent, 0.0, 1e-9);
  EXPECT_NEAR(s.end_drift_m, 0.0, 1e-12);
  EXPECT_EQ(s.matched, 50);
}

TEST(TrajectoryScore, WithoutAlignmentTheErrorIsTheDistanceOfThePositions) {
  const auto truth = straight(3);
  auto estimate = truth;
  estimate[1].translation.y() = 3.0;
  estimate[2].translation.z() = 4.0;
  const TrajectoryScore s = score(truth, estimate, {.alignment = Alignment::none});
  EXPECT_DOUBLE_EQ(s.ate_m.rmse, 5.0 / std::sqrt(3.0));
  EXPECT_DOUBLE_EQ(s.ate_m.median, 3.0);
}

TEST(TrajectoryScore, AlignmentAtTheOriginMakesTheFirstPosesCoincide) {
  auto estimate = straight(3);
  estimate[2].translation.y() = 1.0;
  const TrajectoryScore s = score(moved(turned(-1.0, {7, 8, 9}), straight(3)),
                                  moved(kElsewhere, estimate), {.alignment = Alignment::origin});
  EXPECT_NEAR(s.ate_m.max, 1.0, 1e-12);
  EXPECT_NEAR(s.ate_m.min, 0.0, 1e-12);
}

// Positions -1, 0, 1 against -2, 0, 2: the rigid fit leaves 1, 0, 1; the scale is one half.
TEST(TrajectoryScore, OnlySim3ForgivesAWrongScale) {
  const auto truth = straight(3), estimate = moved(kElsewhere, straight(3, 2.0));
  const TrajectoryScore rigid = score(truth, estimate);
  EXPECT_NEAR(rigid.ate_m.rmse, std::sqrt(2.0 / 3.0), 1e-12);
  EXPECT_EQ(rigid.scale, 1.0);
  const TrajectoryScore similar = score(truth, estimate, {.alignment = Alignment::sim3});
  EXPECT_NEAR(similar.ate_m.rmse, 0.0, 1e-12);
  EXPECT_NEAR(similar.scale, 0.5, 1e-12);
}

TEST(TrajectoryScore, DoesNotChangeWhenEitherWorldIsMoved) {
  const auto truth = wandering(60, 1), estimate = wandering(60, 2);
  const TrajectoryScoreParams params{.rpe_unit = RpeUnit::metres, .rpe_delta = 2.0};
  const TrajectoryScore here = score(truth, estimate, params);
  const TrajectoryScore there =
      score(moved(kElsewhere, truth), moved(turned(-1.0, {7, 8, 9}), estimate), params);
  EXPECT_NEAR(here.ate_m.rmse, there.ate_m.rmse, 1e-9);
  EXPECT_GT(here.ate_m.rmse, 0.1);
  EXPECT_NEAR(here.rpe_translation_m.rmse, there.rpe_translation_m.rmse, 1e-9);
  EXPECT_NEAR(here.rpe_rotation_deg.rmse, there.rpe_rotation_deg.rmse, 1e-6);
  EXPECT_NEAR(here.segments_overall.t_rel_percent, there.segments_overall.t_rel_percent, 1e-9);
  EXPECT_NEAR(here.end_drift_m, there.end_drift_m, 1e-9);
}

// Every step is 2 % too long and turns by 0.01 rad too much.
TEST(TrajectoryScore, RelativeErrorsAreThoseOfOneStep) {
  std::vector<SE3> estimate = {SE3{}};
  for (int i = 1; i < 10; ++i) estimate.push_back(estimate.back() * turned(0.01, {1.02, 0.0, 0.0}));
  const TrajectoryScore s = score(straight(10), estimate);
  EXPECT_EQ(s.rpe_translation_m.count, 9);
  EXPECT_NEAR(s.rpe_translation_m.rmse, 0.02, 1e-12);
  EXPECT_NEAR(s.rpe_rotation_deg.mean, 0.01 * 180.0 / std::numbers::pi, 1e-9);
}

TEST(TrajectoryScore, SegmentErrorsAreShareOfTheLengthAsInTheKittiKit) {
  // 2 % too long. A segment ends at the first frame more than its length ahead: 101 m for 100 m.
  const TrajectoryScore s = score(straight(251), straight(251, 1.02));
  ASSERT_EQ(s.segments.size(), 8U);
  EXPECT_EQ(s.segments[0].segments, 15);  // starts at frames 0, 10 .. 140, ends at 101 .. 241
  EXPECT_NEAR(s.segments[0].t_rel_percent, 2.02, 1e-9);
  EXPECT_EQ(s.segments[1].segments, 5);
  EXPECT_NEAR(s.segments[1].t_rel_percent, 2.01, 1e-9);
  EXPECT_EQ(s.segments[2].segments, 0);
  EXPECT_EQ(s.segments_overall.segments, 20);
  EXPECT_NEAR(s.segments_overall.t_rel_percent, (15 * 2.02 + 5 * 2.01) / 20, 1e-9);
}

TEST(TrajectoryScore, SegmentRotationIsDegreesPerMetre) {
  std::vector<SE3> estimate = straight(21);
  for (std::size_t i = 0; i < estimate.size(); ++i)
    estimate[i].rotation = turned(0.001 * static_cast<double>(i), Eigen::Vector3d::Zero()).rotation;
  const TrajectoryScore s =
      score(straight(21), estimate, {.segment_start_step = 1, .segment_lengths_m = {9.5}});
  EXPECT_EQ(s.segments[0].segments, 11);
  EXPECT_NEAR(s.segments[0].r_rel_deg_per_m, 0.010 / 9.5 * 180.0 / std::numbers::pi, 1e-9);
}

TEST(TrajectoryScore, ShortWaysGetShortSegments) {
  EXPECT_THAT(segment_lengths_for(60.0), ElementsAre(5, 10, 15, 20, 25, 30, 35, 40));
  EXPECT_DOUBLE_EQ(segment_lengths_for(5.4).back(), 4.0);
  EXPECT_DOUBLE_EQ(segment_lengths_for(3000.0).front(), 100.0);
  EXPECT_DOUBLE_EQ(segment_lengths_for(3000.0).back(), 800.0);
  EXPECT_THAT(segment_lengths_for(0.0), IsEmpty());
}

TEST(TrajectoryScore, EndDriftIsTheLastPositionSeenFromTheFirstPose) {
  const TrajectoryScore s = score(straight(11), moved(kElsewhere, straight(11, 1.05)));
  EXPECT_NEAR(s.end_drift_m, 0.5, 1e-12);
  EXPECT_NEAR(s.end_drift_percent, 5.0, 1e-9);
  EXPECT_NEAR(s.path_length_m, 10.0, 1e-12);
}

TEST(TrajectoryScore, AStandingCameraScoresWithoutAWay) {
  const std::vector<SE3> standing(5, kElsewhere);
  const TrajectoryScore s = score(standing, standing);
  EXPECT_NEAR(s.ate_m.max, 0.0, 1e-12);
  EXPECT_EQ(s.end_drift_percent, 0.0);
  EXPECT_THAT(s.segments, IsEmpty());
  EXPECT_THROW(score(standing, standing, {.alignment = Alignment::sim3}), Error);
}

TEST(TrajectoryScore, APoseThatIsNotFiniteIsAnError) {
  auto estimate = straight(3);
  estimate[1].translation.x() = std::nan("");
  try {
    score(straight(3), estimate);
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "trajectories: matched pose 1 of the estimate is not finite");
  }
}

TEST(TrajectoryScore, ParametersAreSetByName) {
  TrajectoryScoreParams params;
  apply_settings({{"alignment", "sim3"}, {"rpe_unit", "metres"}, {"rpe_delta", "1"}}, params);
  EXPECT_EQ(params.alignment, Alignment::sim3);
  EXPECT_EQ(params.rpe_unit, RpeUnit::metres);
}

}  // namespace
}  // namespace stereovox
