#include "stereovox/odometry/odometry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core/utility.hpp>
#include <random>

#include "stereovox/core/error.h"
#include "stereovox/core/timestamp.h"

namespace stereovox {
namespace {

const RectifiedCamera kCamera{{240, 160, 200.0, 200.0, 119.5, 79.5}, 0.12};
constexpr double kFramesPerSecond = 10.0;

// --- A room with textured walls, floor and ceiling around the origin; exact truth. ---

double lattice(int x, int y, int z) {
  std::uint32_t h = static_cast<std::uint32_t>(x) * 73856093U ^
                    static_cast<std::uint32_t>(y) * 19349663U ^
                    static_cast<std::uint32_t>(z) * 83492791U;
  h = (h ^ (h >> 13)) * 0x5bd1e995U;
  return static_cast<double>((h ^ (h >> 15)) & 0xffffU) / 65535.0;
}

// Smooth noise in [0, 1] with features of the size `cell_m`.
double texture(const Eigen::Vector3d& p, double cell_m) {
  const Eigen::Vector3d q = p / cell_m;
  const Eigen::Vector3i i = q.array().floor().cast<int>();
  const Eigen::Array3d t = (q - i.cast<double>()).array();
  const Eigen::Array3d s = t * t * (3.0 - 2.0 * t);
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Array3i bit(corner & 1, corner >> 1 & 1, corner >> 2);
    const Eigen::Array3d w = bit.cast<double>() * s + (1 - bit.cast<double>()) * (1.0 - s);
    sum += w.prod() * lattice(i.x() + bit.x(), i.y() + bit.y(), i.z() + bit.z());
  }
  return sum;
}

// How far along a ray from inside the room its wall is.
double distance_to_wall(const Eigen::Vector3d& from, const Eigen::Vector3d& direction) {
  const Eigen::Array3d half_size_m(3.0, 1.5, 4.0);
  const Eigen::Array3d wall = direction.array().sign() * half_size_m;
  return ((wall - from.array()) / direction.array()).minCoeff();
}

struct View {
  cv::Mat1b brightness = cv::Mat1b(kCamera.pinhole.height, kCamera.pinhole.width);
  cv::Mat1f depth_m = cv::Mat1f(kCamera.pinhole.height, kCamera.pinhole.width);
};

View view_from(const SE3& T_world_camera, std::mt19937& random) {
  std::normal_distribution<double> noise(0.0, 1.0);
  View view;
  for (int v = 0; v < view.brightness.rows; ++v)
    for (int u = 0; u < view.brightness.cols; ++u) {
      const auto& pinhole = kCamera.pinhole;
      const Eigen::Vector3d ray =
          T_world_camera.rotation * Eigen::Vector3d((u - pinhole.cx_px) / pinhole.fx_px,
                                                    (v - pinhole.cy_px) / pinhole.fy_px, 1.0);
      const double depth_m = distance_to_wall(T_world_camera.translation, ray);
      const Eigen::Vector3d p = T_world_camera.translation + depth_m * ray;
      const double value = 30.0 + 110.0 * texture(p, 0.3) + 90.0 * texture(p, 0.12);
      view.brightness(v, u) = cv::saturate_cast<std::uint8_t>(value + noise(random));
      view.depth_m(v, u) = static_cast<float>(depth_m);
    }
  return view;
}

struct Shot {
  RectifiedPair pair;
  DisparityImage disparity;
};

// Noise of image and disparity differs with the number of the frame.
Shot shot_from(const SE3& T_world_camera, int frame) {
  std::mt19937 random(static_cast<unsigned>(frame));
  const View left = view_from(T_world_camera, random);
  const SE3 T_left_right{Eigen::Quaterniond::Identity(), {kCamera.baseline_m, 0, 0}};
  const View right = view_from(T_world_camera * T_left_right, random);
  Shot shot;
  shot.pair.stamp_ns = ns_from_seconds(frame / kFramesPerSecond);
  shot.pair.left.pixels = left.brightness;
  shot.pair.right.pixels = right.brightness;
  shot.disparity = {cv::Mat1f(left.depth_m.size()), cv::Mat1f(left.depth_m.size(), 0.35F)};
  std::normal_distribution<float> noise(0.0F, 0.2F);
  for (int v = 0; v < left.depth_m.rows; ++v)
    for (int u = 0; u < left.depth_m.cols; ++u)
      shot.disparity.disparity_px(v, u) =
          static_cast<float>(kCamera.disparity_px(left.depth_m(v, u))) + noise(random);
  return shot;
}

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

TEST(Odometry, KeepsNoMoreKeyframesThanAllowedAndStillTracks) {
  OdometryParams params;
  params.keyframes.stored_count = 1;
  params.keyframes.max_shift = 0.001;
  Odometry odometry(kCamera, params);
  for (int frame = 0; frame < 10; ++frame) {
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
