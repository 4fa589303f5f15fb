#include "stereovox/odometry/direct_alignment.h"

#include <gtest/gtest.h>

#include <vector>

#include "stereovox/odometry/image_levels.h"
#include "stereovox/odometry/room_for_test.h"

namespace stereovox {
namespace {

constexpr Paint kClouds{.plain_from_x_m = -1e9};
constexpr int kHalvings = 3;

struct Levels {
  std::vector<RectifiedCamera> cameras;
  std::vector<SurfaceLevel> surfaces;
};

// Halved once, twice, ...
Levels levels_of(const Shot& shot) {
  Levels levels;
  RectifiedCamera camera = kCamera;
  PairLevel images{shot.pair, shot.disparity};
  for (int i = 0; i < kHalvings; ++i) {
    camera = halved(camera);
    images = halved(images);
    levels.cameras.push_back(camera);
    levels.surfaces.push_back({images.pair.left, images.disparity.disparity_px});
  }
  return levels;
}

DirectAlignment align(const Shot& reference, const Shot& current, const SE3& start = {}) {
  const Levels a = levels_of(reference), b = levels_of(current);
  std::vector<DirectPair> pairs;
  for (std::size_t i = a.surfaces.size(); i-- > 0;)
    pairs.push_back({a.cameras[i], a.surfaces[i], b.surfaces[i].left});
  return align_directly(pairs, start);
}

SE3 moved() {
  Vector6d motion;
  motion << 0.05, -0.02, 0.08, 0.03, 0.1, -0.02;
  return exp(motion);
}

TEST(DirectAlignment, FindsAMotionFromCloudsAlone) {
  const DirectAlignment found = align(shot_from(SE3{}, 1, kClouds), shot_from(moved(), 2, kClouds));
  const Vector6d error = log(inverse(moved()) * found.T_reference_camera);
  EXPECT_LT(error.head<3>().norm(), 0.02);
  EXPECT_LT(error.tail<3>().norm(), 0.005);
  EXPECT_GT(found.correlation, 0.95);
  EXPECT_GT(found.overlap, 0.6);
}

TEST(DirectAlignment, ExposureDoesNotMatter) {
  Shot darker = shot_from(moved(), 2, kClouds);
  for (std::uint8_t& value : darker.pair.left.pixels)
    value = cv::saturate_cast<std::uint8_t>(0.6 * value + 11.0);
  const DirectAlignment found = align(shot_from(SE3{}, 1, kClouds), darker);
  EXPECT_LT(log(inverse(moved()) * found.T_reference_camera).norm(), 0.02);
  EXPECT_GT(found.correlation, 0.9);
}

TEST(DirectAlignment, TheCovarianceTellsHowFarItIsOff) {
  double sum = 0.0;
  constexpr int kTrials = 10;
  for (int trial = 0; trial < kTrials; ++trial) {
    const DirectAlignment found =
        align(shot_from(SE3{}, 100 + trial, kClouds), shot_from(moved(), 200 + trial, kClouds));
    const Vector6d error = log(inverse(moved()) * found.T_reference_camera);
    sum += error.dot(found.covariance.inverse() * error);
  }
  // 6 on average if it were exact; never far too small, and not useless.
  EXPECT_LT(sum / kTrials, 18.0);
  EXPECT_GT(sum / kTrials, 0.1);
}

TEST(DirectAlignment, AnotherViewDoesNotCorrelate) {
  Vector6d turn = Vector6d::Zero();
  turn[4] = 2.0;
  const DirectAlignment found =
      align(shot_from(SE3{}, 1, kClouds), shot_from(exp(turn), 2, kClouds));
  EXPECT_FALSE(found.correlation > DirectParams{}.min_correlation &&
               found.overlap > DirectParams{}.min_overlap)
      << found.correlation << " " << found.overlap;
}

TEST(DirectAlignment, WhatHasNoBrightnessOrNoDepthFixesNothing) {
  const Shot seen = shot_from(SE3{}, 1, kClouds);
  Shot blank = seen, unknown = seen;
  blank.pair.left.pixels = cv::Mat1b(blank.pair.left.pixels.size(), std::uint8_t{90});
  unknown.disparity.disparity_px = cv::Mat1f(unknown.disparity.disparity_px.size(), 0.0F);
  EXPECT_FALSE(align(blank, blank).covariance.allFinite());
  EXPECT_FALSE(align(unknown, seen).covariance.allFinite());
}

}  // namespace
}  // namespace stereovox
