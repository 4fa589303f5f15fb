#include "stereovox/odometry/odometry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core/utility.hpp>
#include <random>

#include "stereovox/core/error.h"
#include "stereovox/odometry/room_for_test.h"

namespace stereovox {
namespace {

Shot dark(Shot shot) {
  shot.pair.left.pixels = 3;
  shot.pair.right.pixels = 3;
  shot.disparity.disparity_px = 0.0F;
  return shot;
}

// A pattern of half the contrast, with more noise.
Shot faint(Shot shot, int frame) {
  constexpr double kContrast = 0.5, kNoise_gray = 1.5;
  std::mt19937 random(static_cast<unsigned>(1000 + frame));
  std::normal_distribution<double> noise(0.0, kNoise_gray);
  for (cv::Mat1b* image : {&shot.pair.left.pixels, &shot.pair.right.pixels})
    for (std::uint8_t& value : *image)
      value = cv::saturate_cast<std::uint8_t>(100 + kContrast * value + noise(random));
  return shot;
}

// Forward in a gentle curve.
SE3 on_the_way(int frame) {
  const double s = 0.06 * frame;
  Vector6d turn;
  turn << 0, 0, 0, 0.01 * std::sin(s * 5.0), 0.3 * s, 0;
  return SE3{Eigen::Quaterniond::Identity(), {0.3 * std::sin(s), 0.0, s - 1.5}} * exp(turn);
}

SE3 elsewhere(int frame) {
  Vector6d turned;
  turned << 0, 0, 0, 0, 2.4, 0;
  return SE3{Eigen::Quaterniond::Identity(), {1.0, 0.2, 0.05 * frame}} * exp(turned);
}

OdometryResult track(Odometry& odometry, const Shot& shot) {
  return odometry.track(shot.pair, shot.disparity);
}

// Between the pose found and the true one, both since frame 0 of the way.
Vector6d error_on_the_way(const OdometryResult& result, int frame) {
  return log(inverse(inverse(on_the_way(0)) * on_the_way(frame)) * result.T_segment_camera);
}

constexpr double kTolerance_m = 0.015, kTolerance_rad = 0.003;

void expect_right(const OdometryResult& result, int frame) {
  ASSERT_EQ(result.status, OdometryStatus::tracked) << "frame " << frame << ": " << result.reason;
  const Vector6d error = error_on_the_way(result, frame);
  EXPECT_LT(error.head<3>().norm(), kTolerance_m) << "frame " << frame;
  EXPECT_LT(error.tail<3>().norm(), kTolerance_rad) << "frame " << frame;
}

TEST(Odometry, FollowsAKnownPath) {
  Odometry odometry(kCamera, {});
  for (int frame = 0; frame < 25; ++frame) {
    const OdometryResult result = track(odometry, shot_from(on_the_way(frame), frame));
    expect_right(result, frame);
    EXPECT_EQ(result.segment, 0);
    EXPECT_EQ(result.reason, "");
  }
}

TEST(Odometry, TakesBigStepsWithoutPrediction) {
  Odometry odometry(kCamera, {});
  for (const int frame : {0, 5, 10, 14, 20})
    expect_right(track(odometry, shot_from(on_the_way(frame), frame)), frame);
}

TEST(Odometry, StandingCameraStaysWhereItIs) {
  Odometry odometry(kCamera, {});
  track(odometry, shot_from(on_the_way(0), 0));
  for (int frame = 1; frame < 15; ++frame) {
    const OdometryResult result = track(odometry, shot_from(on_the_way(0), frame));
    ASSERT_EQ(result.status, OdometryStatus::tracked);
    EXPECT_FALSE(result.is_keyframe);
    // The noise of one frame; it does not add up.
    EXPECT_LT(result.T_segment_camera.translation.norm(), 0.003) << "frame " << frame;
  }
}

TEST(Odometry, CovarianceTellsHowFarThePoseIsOff) {
  double sum = 0.0;
  constexpr int trials = 20;
  for (int trial = 0; trial < trials; ++trial) {
    Odometry odometry(kCamera, {});
    track(odometry, shot_from(on_the_way(0), 100 + trial));
    const OdometryResult result = track(odometry, shot_from(on_the_way(1), 200 + trial));
    const Vector6d error = error_on_the_way(result, 1);
    sum += error.dot(result.covariance.inverse() * error);
  }
  // 6 on average if it were exact; never far too small, and not useless.
  EXPECT_LT(sum / trials, 12.0);
  EXPECT_GT(sum / trials, 0.3);
}

TEST(Odometry, FirstFramesWithoutTextureAreLostUntilOneHasSome) {
  Odometry odometry(kCamera, {});
  const OdometryResult blind = track(odometry, dark(shot_from(on_the_way(0), 0)));
  EXPECT_EQ(blind.status, OdometryStatus::lost);
  EXPECT_EQ(blind.reason, "0 corners have a disparity, 20 are needed to start");
  const OdometryResult first = track(odometry, shot_from(on_the_way(0), 1));
  EXPECT_EQ(first.status, OdometryStatus::tracked);
  EXPECT_TRUE(first.is_keyframe);
  EXPECT_EQ(log(first.T_segment_camera).norm(), 0.0);
}

TEST(Odometry, AfterDarkFramesItGoesOnInTheSameSegment) {
  Odometry odometry(kCamera, {});
  for (int frame = 0; frame < 5; ++frame) track(odometry, shot_from(on_the_way(frame), frame));
  const OdometryResult before = track(odometry, shot_from(on_the_way(5), 5));
  for (int frame = 6; frame < 9; ++frame) {
    const OdometryResult lost = track(odometry, dark(shot_from(on_the_way(frame), frame)));
    EXPECT_EQ(lost.status, OdometryStatus::lost);
    EXPECT_EQ(lost.reason, "0 of 0 matches are consistent, 10 are needed");
    EXPECT_EQ(log(inverse(before.T_segment_camera) * lost.T_segment_camera).norm(), 0.0);
  }
  const OdometryResult after = track(odometry, shot_from(on_the_way(9), 9));
  expect_right(after, 9);
  EXPECT_EQ(after.segment, 0);
}

TEST(Odometry, CameraPutElsewhereStartsANewSegmentAndFindsBackToTheOldOne) {
  Odometry odometry(kCamera, {});
  for (int frame = 0; frame < 4; ++frame) track(odometry, shot_from(on_the_way(frame), frame));

  EXPECT_EQ(track(odometry, shot_from(elsewhere(4), 4)).status, OdometryStatus::lost);
  const OdometryResult begun = track(odometry, shot_from(elsewhere(5), 5));
  EXPECT_EQ(begun.status, OdometryStatus::tracked);
  EXPECT_EQ(begun.segment, 1);
  EXPECT_LT(log(begun.T_segment_camera).norm(), 1e-3);
  for (int frame = 6; frame < 10; ++frame) {
    const OdometryResult result = track(odometry, shot_from(elsewhere(frame), frame));
    ASSERT_EQ(result.segment, 1);
    const SE3 truth = inverse(elsewhere(5)) * elsewhere(frame);
    EXPECT_LT(log(inverse(truth) * result.T_segment_camera).norm(), kTolerance_m);
  }

  const OdometryResult back = track(odometry, shot_from(on_the_way(3), 10));
  EXPECT_EQ(back.segment, 0);
  expect_right(back, 3);
}

TEST(Odometry, AJumpOfTheClockChangesNothingButThePrediction) {
  for (const double jump_s : {3600.0, -3600.0}) {
    Odometry odometry(kCamera, {});
    for (int frame = 0; frame < 6; ++frame) {
      Shot shot = shot_from(on_the_way(frame), frame);
      if (frame >= 3) shot.pair.stamp_ns += ns_from_seconds(jump_s);
      expect_right(track(odometry, shot), frame);
    }
  }
}

TEST(Odometry, MotionFasterThanBelievedIsLost) {
  OdometryParams params;
  params.quality.max_speed_m_per_s = 0.3;
  Odometry odometry(kCamera, params);
  track(odometry, shot_from(on_the_way(0), 0));
  const OdometryResult result = track(odometry, shot_from(on_the_way(2), 1));
  EXPECT_EQ(result.status, OdometryStatus::lost);
  EXPECT_THAT(result.reason, testing::HasSubstr("0.3 and 400 are believed"));
}

std::vector<OdometryResult> results_with_threads(int threads) {
  const int threads_before = cv::getNumThreads();
  cv::setNumThreads(threads);
  Odometry odometry(kCamera, {});
  std::vector<OdometryResult> results;
  for (int frame = 0; frame < 8; ++frame)
    results.push_back(track(odometry, shot_from(on_the_way(frame), frame)));
  cv::setNumThreads(threads_before);
  return results;
}

TEST(Odometry, ResultIsTheSameForAnyNumberOfThreads) {
  const auto one = results_with_threads(1), four = results_with_threads(4);
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].T_segment_camera.translation, four[i].T_segment_camera.translation);
    EXPECT_EQ(one[i].covariance, four[i].covariance);
  }
}

TEST(Odometry, WeakTextureIsTrackedOnHalvedImages) {
  constexpr int kFrames = 8;
  constexpr double kWeakTolerance_m = 0.05, kWeakTolerance_rad = 0.02;
  constexpr double kMinGradient_px = 5.0;  // few corners of the full image have as much
  OdometryParams params;
  params.features.min_gradient_px = kMinGradient_px;
  OdometryParams full_only = params;
  full_only.keyframes.coarser_levels = 0;
  Odometry odometry(kCamera, params), on_full_images(kCamera, full_only);
  int lost_on_full_images = 0, halved = 0;
  for (int frame = 0; frame < kFrames; ++frame) {
    const Shot shot = faint(shot_from(on_the_way(frame), frame), frame);
    lost_on_full_images += track(on_full_images, shot).status == OdometryStatus::lost ? 1 : 0;
    const OdometryResult result = track(odometry, shot);
    ASSERT_EQ(result.status, OdometryStatus::tracked) << frame << ": " << result.reason;
    halved += result.level > 0 ? 1 : 0;
    const Vector6d error = error_on_the_way(result, frame);
    EXPECT_LT(error.head<3>().norm(), kWeakTolerance_m) << frame;
    EXPECT_LT(error.tail<3>().norm(), kWeakTolerance_rad) << frame;
  }
  EXPECT_GT(lost_on_full_images, kFrames / 2);
  EXPECT_GT(halved, kFrames / 2);
}

// To the right until only a wall without corners is in view, and back.
TEST(Odometry, AWallWithoutCornersIsPassedByItsClouds) {
  constexpr double kStep_rad = 0.1, kCloudTolerance_m = 0.15, kCloudTolerance_rad = 0.03;
  constexpr int kFrames = 26;
  const auto looking_right = [](int frame) {
    Vector6d turn = Vector6d::Zero();
    turn[4] = kStep_rad * std::min(frame, kFrames - frame);
    return exp(turn);
  };
  OdometryParams params;  // hardly makes keyframes where it has corners
  params.keyframes.max_turn_deg = 90.0;
  params.keyframes.min_consistent_share = 0.0;
  OdometryParams never = params;
  never.direct.min_correlation = 1.0;
  Odometry odometry(kCamera, params), without(kCamera, never);
  int by_clouds = 0, lost_without = 0;
  for (int frame = 0; frame < kFrames; ++frame) {
    const Shot shot = shot_from(looking_right(frame), frame, {.plain_from_x_m = 0.7});
    const OdometryResult result = track(odometry, shot);
    ASSERT_EQ(result.status, OdometryStatus::tracked) << frame << ": " << result.reason;
    EXPECT_EQ(result.segment, 0);
    by_clouds += frame > 0 && result.inliers == 0 ? 1 : 0;
    lost_without += track(without, shot).status == OdometryStatus::lost ? 1 : 0;
    const Vector6d error = log(inverse(looking_right(frame)) * result.T_segment_camera);
    EXPECT_LT(error.head<3>().norm(), kCloudTolerance_m) << frame;
    EXPECT_LT(error.tail<3>().norm(), kCloudTolerance_rad) << frame;
  }
  EXPECT_GT(by_clouds, 2);
  EXPECT_GT(lost_without, 2);
}

// One sudden motion of a camera at rest, as far as half a period and more: corners agree as well on
// the motion that is a period less.
TEST(Odometry, ASuddenMotionBeforeAPatternIsNotTakenForOneAPeriodLess) {
  constexpr double kStep_m = 0.22, kTurn_rad = 0.06;
  Vector6d step = Vector6d::Zero(), turn = Vector6d::Zero();
  step[0] = kStep_m;
  turn[4] = kTurn_rad;
  for (const Vector6d& motion : {step, Vector6d(-step), turn, Vector6d(-turn)}) {
    Odometry odometry(kCamera, {});
    for (int frame = 0; frame < 5; ++frame) {
      const SE3 truth = frame < 3 ? SE3{} : exp(motion);
      const OdometryResult result = track(odometry, shot_from(truth, frame, {.period_m = 0.4}));
      ASSERT_EQ(result.status, OdometryStatus::tracked) << result.reason;
      const Vector6d error = log(inverse(truth) * result.T_segment_camera);
      EXPECT_LT(error.head<3>().norm(), kTolerance_m) << motion.transpose() << ", " << frame;
      EXPECT_LT(error.tail<3>().norm(), kTolerance_rad) << motion.transpose() << ", " << frame;
    }
  }
}

TEST(Odometry, KeepsNoMoreKeyframesThanAllowedAndStillTracks) {
  OdometryParams params;
  params.keyframes.memory_mb = 1.0;  // far less than the frames below need
  params.keyframes.max_shift = 0.001;
  Odometry odometry(kCamera, params);
  for (int frame = 0; frame < 40; ++frame) {
    const OdometryResult result = track(odometry, shot_from(on_the_way(frame), frame));
    expect_right(result, frame);
    EXPECT_TRUE(result.is_keyframe);
  }
}

TEST(Odometry, ImagesOfTheWrongSizeAreAnErrorWithTheNumbers) {
  Odometry odometry(kCamera, {});
  Shot shot = shot_from(on_the_way(0), 0);
  shot.pair.right.pixels = cv::Mat1b(100, 240, std::uint8_t{0});
  try {
    track(odometry, shot);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "odometry: right image is 240 x 100, the camera says 240 x 160");
  }
}

TEST(Odometry, DefaultParametersAreInTheirRanges) {
  OdometryParams params;
  const ParameterList list = parameters_of(params);
  for (const Parameter& parameter : list.parameters())
    EXPECT_NO_THROW(list.set(parameter.path, parameter.get())) << parameter.path;
}

}  // namespace
}  // namespace stereovox
