#include "stereovox/stereo/edge_medians.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/core.hpp>
#include <random>
#include <utility>
#include <vector>

#include "stereovox/stereo/row_kernels.h"

namespace stereovox {
namespace {

constexpr int kContrast_gray = 48;
constexpr std::int16_t kNear = 20 * kStepsPerPixel, kFar = 5 * kStepsPerPixel;
constexpr std::uint8_t kBright = 160, kDark = 60;

cv::Mat1s settled(cv::Mat1s disparity, const cv::Mat1b& left, int contrast_gray = kContrast_gray,
                  int threads = 1) {
  settle_edges(left, contrast_gray, disparity, threads);
  return disparity;
}

int plain_median(const cv::Mat1s& disparity, const cv::Mat1b& left, int contrast_gray, int v,
                 int u) {
  std::vector<std::pair<int, int>> around;  // disparity, weight
  int total = 0;
  for (int y = std::max(0, v - 3); y <= std::min(disparity.rows - 1, v + 3); ++y)
    for (int x = std::max(0, u - 3); x <= std::min(disparity.cols - 1, u + 3); ++x) {
      if (disparity(y, x) <= 0) continue;
      around.emplace_back(disparity(y, x),
                          std::max(0, contrast_gray - std::abs(left(y, x) - left(v, u))));
      total += around.back().second;
    }
  std::ranges::sort(around);
  if (disparity(v, u) <= 0 || around.back().first - around[0].first <= 3 * kStepsPerPixel / 2)
    return disparity(v, u);
  int below = 0;
  for (const auto& [value, weight] : around)
    if (2 * (below += weight) >= total) return value;
  return 0;
}

cv::Mat1s random_steps(cv::Size size) {
  std::mt19937 random(3);
  cv::Mat1s image(size);
  for (std::int16_t& d : image) {
    const int surface = static_cast<int>(random() % 4) * 700;  // the first is none
    d = static_cast<std::int16_t>(surface > 0 ? surface + static_cast<int>(random() % 40) : 0);
  }
  return image;
}

class SettledEdgesOfSize : public testing::TestWithParam<cv::Size> {};

INSTANTIATE_TEST_SUITE_P(Sizes, SettledEdgesOfSize,
                         testing::Values(cv::Size(1, 1), cv::Size(2, 3), cv::Size(16, 5),
                                         cv::Size(17, 1), cv::Size(83, 40)));

TEST_P(SettledEdgesOfSize, AreTheMediansAsTheyAreFoundPlainly) {
  const cv::Mat1s image = random_steps(GetParam());
  cv::Mat1b left(GetParam());
  cv::RNG(1).fill(left, cv::RNG::UNIFORM, 0, 256);
  for (const int contrast : {1, kContrast_gray, 255})
    for (const int threads : {1, 3}) {
      const cv::Mat1s found = settled(image.clone(), left, contrast, threads);
      for (int v = 0; v < image.rows; ++v)
        for (int u = 0; u < image.cols; ++u)
          ASSERT_EQ(found(v, u), plain_median(image, left, contrast, v, u)) << v << " " << u;
    }
}

TEST(SettledEdges, ASurfaceEndsWhereItsPictureEnds) {
  cv::Mat1b left(20, 40, kBright);
  cv::Mat1s grown(left.size(), kFar), expected = grown.clone();
  left.colRange(20, 40).setTo(kDark);
  grown.colRange(18, 40).setTo(kNear);
  expected.colRange(20, 40).setTo(kNear);
  EXPECT_EQ(cv::countNonZero(settled(grown, left) != expected), 0);
}

TEST(SettledEdges, AThinThingOfItsOwnBrightnessStays) {
  cv::Mat1b left(20, 40, kBright);
  cv::Mat1s disparity(left.size(), kFar);
  left.colRange(20, 22).setTo(kDark);
  disparity.colRange(20, 22).setTo(kNear);
  EXPECT_EQ(cv::countNonZero(settled(disparity.clone(), left) != disparity), 0);
}

TEST(SettledEdges, WhatHasNoDisparityGetsNone) {
  cv::Mat1s disparity(20, 40, kFar);
  disparity.colRange(20, 40).setTo(kNear);
  disparity.colRange(18, 22).setTo(0);
  const cv::Mat1b left(disparity.size(), kDark);
  EXPECT_EQ(cv::countNonZero(settled(disparity.clone(), left).colRange(18, 22)), 0);
}

TEST(SettledEdges, StayAsTheyAreOnRequest) {
  const cv::Mat1s image = random_steps({40, 30});
  EXPECT_EQ(cv::countNonZero(settled(image.clone(), cv::Mat1b(image.size(), kDark), 0) != image),
            0);
}

}  // namespace
}  // namespace stereovox
