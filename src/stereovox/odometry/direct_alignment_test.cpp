#include "stereovox/odometry/direct_alignment.h"

#include <gtest/gtest.h>

#include <vector>

#include "stereovox/odometry/halved_levels_for_test.h"

namespace stereovox {
namespace {

constexpr Paint kClouds{.plain_from_x_m = -1e9};

struct Levels {
  std::vector<RectifiedCamera> cameras;
  std::vector<SurfaceLevel> surfaces;
};

Levels levels_of(const Shot& shot) {
  Levels levels;
  for (const HalvedLevel& level : halved_levels_of(shot)) {
    levels.cameras.push_back(level.camera);
    levels.surfaces.push_back({detail_of(level.images.pair), level.images.disparity.disparity_px});
  }
  return levels;
}

SE3 turned(double angle_rad) {
  Vector6d turn = Vector6d::Zero();
  turn[4] = angle_rad;
  return exp(turn);
}

constexpr double kStartStep_rad = 0.07;

DirectAlignment align(const Shot& reference, const Shot& current,
                      const std::vector<SE3>& starts = {SE3{}, turned(-kStartStep_rad),
                                                        turned(kStartStep_rad)}) {
  const Levels a = levels_of(reference), b = levels_of(current);
  std::vector<DirectPair> pairs;
  for (std::size_t i = a.surfaces.size(); i-- > 0;)
    pairs.push_back({a.cameras[i], a.surfaces[i], b.surfaces[i].detail});
  return align_directly(pairs, starts);
}

bool is_believed(const DirectAlignment& found) {
  const DirectParams params;
  return found.overlap >= params.min_overlap && found.correlation >= params.min_correlation &&
         found.residual_ratio <= params.max_residual_ratio;
}

// A lens that shows a quarter less in the corners.
Shot vignetted(Shot shot) {
  for (cv::Mat1b* image : {&shot.pair.left.pixels, &shot.pair.right.pixels})
    for (int v = 0; v < image->rows; ++v)
      for (int u = 0; u < image->cols; ++u) {
        const double x = (u - kCamera.pinhole.cx_px) / kCamera.pinhole.cx_px;
        const double y = (v - kCamera.pinhole.cy_px) / kCamera.pinhole.cy_px;
        std::uint8_t& value = (*image)(v, u);
        value = cv::saturate_cast<std::uint8_t>(value * (1.0 - 0.12 * (x * x + y * y)));
      }
  return shot;
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
  EXPECT_GT(found.overlap, 0.6);
  EXPECT_TRUE(is_believed(found)) << found.correlation << " " << found.residual_ratio;
}

TEST(DirectAlignment, VignettingDoesNotHoldTheCamera) {
  const DirectAlignment found =
      align(vignetted(shot_from(SE3{}, 1, kClouds)), vignetted(shot_from(moved(), 2, kClouds)));
  const Vector6d error = log(inverse(moved()) * found.T_reference_camera);
  EXPECT_LT(error.head<3>().norm(), 0.02);
  EXPECT_LT(error.tail<3>().norm(), 0.005);
  EXPECT_TRUE(is_believed(found)) << found.correlation << " " << found.residual_ratio;
}

TEST(DirectAlignment, TheBestOfSeveralStartsIsFollowed) {
  constexpr double kTurn_rad = 0.5;
  const Shot before = shot_from(SE3{}, 1, kClouds),
             after = shot_from(turned(kTurn_rad), 2, kClouds);
  const std::vector<SE3> starts = {SE3{}, turned(-kTurn_rad), turned(0.9 * kTurn_rad)};
  EXPECT_FALSE(is_believed(align(before, after, {SE3{}, turned(-kTurn_rad)})));
  const DirectAlignment found = align(before, after, starts);
  EXPECT_LT(log(inverse(turned(kTurn_rad)) * found.T_reference_camera).norm(), 0.05);
}

TEST(DirectAlignment, BothImagesMustFit) {
  Shot current = shot_from(moved(), 2, kClouds);
  current.pair.right = shot_from(turned(2.0), 3, kClouds).pair.right;
  EXPECT_FALSE(is_believed(align(shot_from(SE3{}, 1, kClouds), current)));
}

TEST(DirectAlignment, ExposureDoesNotMatter) {
  Shot darker = shot_from(moved(), 2, kClouds);
  for (cv::Mat1b* image : {&darker.pair.left.pixels, &darker.pair.right.pixels})
    for (std::uint8_t& value : *image) value = cv::saturate_cast<std::uint8_t>(0.6 * value + 11.0);
  const DirectAlignment found = align(shot_from(SE3{}, 1, kClouds), darker);
  EXPECT_LT(log(inverse(moved()) * found.T_reference_camera).norm(), 0.02);
  EXPECT_TRUE(is_believed(found)) << found.correlation << " " << found.residual_ratio;
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

TEST(DirectAlignment, AnotherViewIsNotBelieved) {
  EXPECT_FALSE(
      is_believed(align(shot_from(SE3{}, 1, kClouds), shot_from(turned(2.0), 2, kClouds))));
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
