#include "stereovox/stereo/smooth_disparities.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <opencv2/core.hpp>
#include <random>

#include "stereovox/stereo/match_confidence.h"

namespace stereovox {
namespace {

constexpr std::int16_t kNear = 20 * kStepsPerPixel, kFar = 5 * kStepsPerPixel;

cv::Mat1s smoothed(cv::Mat1s image, int threads = 1) {
  smooth_disparities(image, threads);
  return image;
}

int at_border(const cv::Mat1s& image, int v, int u) {
  return image(std::clamp(v, 0, image.rows - 1), std::clamp(u, 0, image.cols - 1));
}

int plain_median(const cv::Mat1s& image, int v, int u) {
  std::array<int, 9> around = {};
  for (int i = 0; i < 9; ++i) around[i] = at_border(image, v + i / 3 - 1, u + i % 3 - 1);
  std::ranges::sort(around);
  return around[4];
}

int plain_mean(const cv::Mat1s& image, int v, int u, int dv, int du) {
  double sum = 0;
  for (int k = -4; k <= 4; ++k) {
    const int step = at_border(image, v + k * dv, u + k * du) - image(v, u);
    sum += std::abs(step) <= kStepsPerPixel ? step : 0;
  }
  return image(v, u) + static_cast<int>(std::floor(sum / 9 + 0.5));
}

template <class Pixel>
cv::Mat1s each(const cv::Mat1s& image, Pixel pixel) {
  cv::Mat1s out(image.size());
  for (int v = 0; v < image.rows; ++v)
    for (int u = 0; u < image.cols; ++u) out(v, u) = static_cast<std::int16_t>(pixel(image, v, u));
  return out;
}

cv::Mat1s plainly_smoothed(const cv::Mat1s& image) {
  const cv::Mat1s medians = each(image, plain_median);
  const cv::Mat1s along =
      each(medians, [](const cv::Mat1s& in, int v, int u) { return plain_mean(in, v, u, 0, 1); });
  return each(along, [](const cv::Mat1s& in, int v, int u) { return plain_mean(in, v, u, 1, 0); });
}

cv::Mat1s noise(cv::Size size, int range) {
  std::mt19937 random(5);
  cv::Mat1s image(size);
  for (std::int16_t& d : image)
    d = static_cast<std::int16_t>(static_cast<int>(random() % static_cast<unsigned>(range)) -
                                  range / 2);
  return image;
}

class SmoothDisparitiesOfSize : public testing::TestWithParam<cv::Size> {};

INSTANTIATE_TEST_SUITE_P(Sizes, SmoothDisparitiesOfSize,
                         testing::Values(cv::Size(1, 1), cv::Size(2, 3), cv::Size(5, 1),
                                         cv::Size(41, 37)));

TEST_P(SmoothDisparitiesOfSize, AreAsTheyAreCalculatedPlainly) {
  for (const int range : {8, 90, 30000}) {
    const cv::Mat1s image = noise(GetParam(), range);
    const cv::Mat1s expected = plainly_smoothed(image);
    for (const int threads : {1, 2})
      EXPECT_EQ(cv::countNonZero(smoothed(image.clone(), threads) != expected), 0) << range;
  }
}

TEST(SmoothDisparities, AnEdgeStaysWhereItIs) {
  cv::Mat1s image(20, 30, kFar);
  image.colRange(13, 30).setTo(kNear);
  EXPECT_EQ(cv::countNonZero(smoothed(image.clone()) != image), 0);
}

TEST(SmoothDisparities, NoiseOfASurfaceShrinksToAThird) {
  const cv::Mat1s image = noise({80, 60}, kStepsPerPixel / 2);
  cv::Scalar mean, before, after;
  cv::meanStdDev(image, mean, before);
  cv::meanStdDev(smoothed(image.clone()), mean, after);
  EXPECT_LT(after[0], before[0] / 3);
}

}  // namespace
}  // namespace stereovox
