// What census_sgm is to see where texture is weak: scenes in which its paths and its census
// mislead.
#include "stereovox/stereo/census_sgm.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <opencv2/imgproc.hpp>

#include "stereovox/stereo/census_rows.h"
#include "stereovox/stereo/synthetic_pair_for_test.h"

namespace stereovox {
namespace {

const cv::Size kSize(320, 240);
const cv::Rect kCompared(60, 40, 240, 180);
constexpr double kGray = 120.0, kNoise_gray = 1.2;

using Brightness = std::function<double(int, int)>;

cv::Mat1b noisy(const Brightness& brightness, cv::RNG& random) {
  cv::Mat1b image(kSize);
  for (int v = 0; v < image.rows; ++v)
    for (int u = 0; u < image.cols; ++u)
      image(v, u) =
          cv::saturate_cast<std::uint8_t>(kGray + brightness(u, v) + random.gaussian(kNoise_gray));
  return image;
}

RectifiedPair noisy_pair(const Brightness& left, const Brightness& right) {
  cv::RNG random(7);
  RectifiedPair pair;
  pair.left.pixels = noisy(left, random);
  pair.right.pixels = noisy(right, random);
  return pair;
}

// Texture as floors have it, which are seen at a slant: rows differ more than columns.
cv::Mat1f floor_texture(double contrast_gray) {
  cv::RNG random(3);
  cv::Mat1f texture(kSize);
  random.fill(texture, cv::RNG::NORMAL, 0.0, 1.0);
  cv::GaussianBlur(texture, texture, {0, 0}, 3.0, 0.7);
  cv::Scalar mean, deviation;
  cv::meanStdDev(texture, mean, deviation);
  return texture * (contrast_gray / deviation[0]);
}

double floor_px(int v) { return 5.0 + 0.12 * v; }

TEST(CensusSgm, FaintFloorsAreHardlyDraggedByThePathsFromAbove) {
  const cv::Mat1f right = floor_texture(8.0);
  cv::Mat1f from_u(kSize), from_v(kSize), left;
  for (int v = 0; v < kSize.height; ++v)
    for (int u = 0; u < kSize.width; ++u) {
      from_u(v, u) = static_cast<float>(u - floor_px(v));
      from_v(v, u) = static_cast<float>(v);
    }
  cv::remap(right, left, from_u, from_v, cv::INTER_CUBIC, cv::BORDER_REFLECT);
  const DisparityImage found = match(noisy_pair([&](int u, int v) { return left(v, u); },
                                                [&](int u, int v) { return right(v, u); }),
                                     CensusSgmParams{}, 1);
  double sum_px = 0;
  int count = 0;
  for (int v = kCompared.y; v < kCompared.br().y; ++v)
    for (int u = kCompared.x; u < kCompared.br().x; ++u)
      if (found.disparity_px(v, u) > 0.0F) {
        sum_px += found.disparity_px(v, u) - floor_px(v);
        ++count;
      }
  EXPECT_GT(count, 40000);
  EXPECT_NEAR(sum_px / count, 0.0, 0.07);
}

// Across a bar at a slant, in pixels from its middle.
double from_bar_px(double u, int v) { return std::abs(v - 120 - 0.8 * (u - 160)); }

// A bar of bare metal shows the room behind the camera: only its edges are where the bar is.
TEST(CensusSgm, TheEdgesOfAMirrorAreWhereItIs) {
  constexpr int kBar_px = 20, kMirrored_px = 10;
  constexpr double kHalfWidth_px = 7.0, kDarker_gray = 40.0, kContrast = 0.1;
  const cv::Mat1b texture = random_texture(kSize, 1);
  const auto room = [&](int u, int v) { return kContrast * (texture(v, std::max(u, 0)) - 128); };
  const auto bar = [&](int u, int v) {
    return kDarker_gray * std::clamp(kHalfWidth_px + 0.5 - from_bar_px(u, v), 0.0, 1.0);
  };
  const DisparityImage found =
      match(noisy_pair([&](int u, int v) { return room(u - kMirrored_px, v) - bar(u, v); },
                       [&](int u, int v) { return room(u, v) - bar(u + kBar_px, v); }),
            CensusSgmParams{}, 1);
  int edge = 0, right = 0;
  for (int v = kCompared.y; v < kCompared.br().y; ++v)
    for (int u = kCompared.x; u < kCompared.br().x; ++u) {
      if (std::abs(from_bar_px(u, v) - kHalfWidth_px) > 2.0) continue;
      ++edge;
      right += std::abs(found.disparity_px(v, u) - kBar_px) < 1.0F ? 1 : 0;
    }
  EXPECT_GT(edge, 1000);
  EXPECT_GT(right, edge / 2);
}

TEST(EquallyExposed, BrightensTheDarkerImageAndLeavesThoseOfTheCallerAlone) {
  for (const double left : {1.0, 0.4}) {
    const double right = 1.4 - left;
    RectifiedPair pair = synthetic_pair(kSize, [](int, int) { return 5.0; });
    pair.left.pixels = pair.left.pixels * left;
    pair.right.pixels = pair.right.pixels * right;
    const cv::Mat1b left_before = pair.left.pixels.clone(),
                    right_before = pair.right.pixels.clone();
    const RectifiedPair equal = equally_exposed(pair);
    EXPECT_NEAR(cv::mean(equal.left.pixels)[0], cv::mean(equal.right.pixels)[0], 1.0);
    EXPECT_GT(cv::mean(equal.left.pixels)[0] + 1.0, cv::mean(left_before)[0]);
    EXPECT_EQ(cv::norm(pair.left.pixels, left_before, cv::NORM_INF), 0.0);
    EXPECT_EQ(cv::norm(pair.right.pixels, right_before, cv::NORM_INF), 0.0);
  }
}

}  // namespace
}  // namespace stereovox
