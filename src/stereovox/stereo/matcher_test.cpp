#include "stereovox/stereo/matcher.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <opencv2/core.hpp>
#include <random>

#include "stereovox/core/error.h"
#include "stereovox/stereo/disparity_picture.h"
#include "stereovox/stereo/synthetic_pair_for_test.h"

namespace stereovox {
namespace {

const cv::Size kSize(320, 240);

double slanted(int u, int v) { return 20.0 + 0.03 * u - 0.04 * v; }

std::string name_of(const testing::TestParamInfo<MatcherParams>& matcher) {
  const auto* const windows = std::get_if<AdaptiveWindowParams>(&matcher.param);
  if (windows != nullptr)
    return names_of(WindowSupport{})[static_cast<std::size_t>(windows->support)];
  return std::visit([](const auto& p) { return std::string(p.kName); }, matcher.param);
}

AdaptiveWindowParams windows(WindowSupport support) {
  AdaptiveWindowParams params;
  params.support = support;
  return params;
}

class EveryMatcher : public testing::TestWithParam<MatcherParams> {};

INSTANTIATE_TEST_SUITE_P(Matchers, EveryMatcher,
                         testing::Values(SemiGlobalMatchingParams{}, BlockMatchingParams{},
                                         CensusSgmParams{}, AdaptiveWindowParams{},
                                         windows(WindowSupport::one_window),
                                         windows(WindowSupport::five_windows),
                                         windows(WindowSupport::nine_windows)),
                         name_of);

double share_right(const DisparityImage& found, cv::Rect where, double tolerance_px) {
  int right = 0;
  for (int v = where.y; v < where.br().y; ++v)
    for (int u = where.x; u < where.br().x; ++u)
      right += std::abs(found.disparity_px(v, u) - slanted(u, v)) < tolerance_px ? 1 : 0;
  return static_cast<double>(right) / where.area();
}

TEST_P(EveryMatcher, FindsASlantedPlaneToAFractionOfAPixel) {
  const DisparityImage found = match(synthetic_pair(kSize, slanted), GetParam());
  EXPECT_GT(share_right(found, {64, 16, 240, 208}, 0.5), 0.95);
}

TEST_P(EveryMatcher, MatchesTheLeftBorderAsFarAsTheRightImageReaches) {
  const DisparityImage found = match(synthetic_pair(kSize, slanted), GetParam());
  EXPECT_GT(share_right(found, {36, 16, 28, 208}, 0.5), 0.85)
      << "columns right of the largest true disparity, left of the searched range";
}

TEST_P(EveryMatcher, NoDisparityReachesOutsideTheRightImage) {
  const DisparityImage found = match(synthetic_pair(kSize, slanted), GetParam());
  for (int v = 0; v < kSize.height; ++v)
    for (int u = 0; u < kSize.width; ++u) EXPECT_LE(found.disparity_px(v, u), u + 0.5);
}

TEST_P(EveryMatcher, GivesASigmaToEachDisparityAndToNothingElse) {
  const DisparityImage found = match(synthetic_pair(kSize, slanted), GetParam());
  EXPECT_EQ(cv::countNonZero((found.disparity_px > 0.0F) != (found.sigma_px > 0.0F)), 0);
}

TEST_P(EveryMatcher, AConstantImageHasNoDisparities) {
  RectifiedPair pair;
  pair.left.pixels = pair.right.pixels = cv::Mat1b(kSize, 128);
  EXPECT_EQ(cv::countNonZero(match(pair, GetParam()).disparity_px), 0);
}

TEST_P(EveryMatcher, PixelsThatACameraDidNotRecordHaveNoDisparity) {
  RectifiedPair pair = synthetic_pair(kSize, slanted);
  pair.valid_left = cv::Mat1b(kSize, 255);
  pair.valid_right = cv::Mat1b(kSize, 255);
  pair.valid_left.colRange(200, 320).setTo(0);
  pair.valid_right.rowRange(0, 100).setTo(0);
  const DisparityImage found = match(pair, GetParam());
  EXPECT_EQ(cv::countNonZero(found.disparity_px.colRange(200, 320)), 0);
  EXPECT_EQ(cv::countNonZero(found.disparity_px.rowRange(0, 100)), 0);
  EXPECT_GT(cv::countNonZero(found.disparity_px), 5000);
}

bool same(const DisparityImage& a, const DisparityImage& b) {
  return cv::countNonZero(a.disparity_px != b.disparity_px) == 0 &&
         cv::countNonZero(a.sigma_px != b.sigma_px) == 0 &&
         (a.confidence.empty() || cv::countNonZero(a.confidence != b.confidence) == 0);
}

TEST_P(EveryMatcher, ResultDoesNotDependOnTheNumberOfThreads) {
  const RectifiedPair pair = synthetic_pair({320, 480}, slanted);
  const int before = cv::getNumThreads();
  cv::setNumThreads(1);
  const DisparityImage one = match(pair, GetParam());
  for (const int threads : {2, 3, 8}) {
    cv::setNumThreads(threads);
    EXPECT_TRUE(same(one, match(pair, GetParam(), threads))) << threads;
  }
  cv::setNumThreads(before);
}

RectifiedPair pair_of(const std::function<std::uint8_t(int, int)>& gray) {
  RectifiedPair pair;
  pair.left.pixels.create(kSize);
  for (int v = 0; v < kSize.height; ++v)
    for (int u = 0; u < kSize.width; ++u) pair.left.pixels(v, u) = gray(u, v);
  pair.right.pixels = pair.left.pixels.clone();
  return pair;
}

double density(const DisparityImage& found) {
  return cv::countNonZero(found.disparity_px) / static_cast<double>(kSize.area());
}

class CensusMatcher : public testing::TestWithParam<MatcherParams> {};

INSTANTIATE_TEST_SUITE_P(Matchers, CensusMatcher,
                         testing::Values(CensusSgmParams{}, AdaptiveWindowParams{},
                                         windows(WindowSupport::five_windows),
                                         windows(WindowSupport::nine_windows)),
                         name_of);

// Of the pixels of the plane that are right within half a pixel, with the right image so many times
// as bright.
double share_right_with_gain(const MatcherParams& params, double gain) {
  RectifiedPair pair = synthetic_pair(kSize, slanted);
  const double darkest = std::min(1.0, 1.0 / gain);  // so that no image is clipped
  pair.left.pixels = pair.left.pixels * darkest;
  pair.right.pixels = pair.right.pixels * (darkest * gain);
  return share_right(match(pair, params), {64, 16, 240, 208}, 0.5);
}

TEST_P(CensusMatcher, OneCameraMayExposeTwiceAsLongAsTheOther) {
  const double alike = share_right_with_gain(GetParam(), 1);
  for (const double gain : {0.5, 0.8, 1.25, 2.0})
    EXPECT_GT(share_right_with_gain(GetParam(), gain), alike - 0.02) << gain;
}

TEST_P(CensusMatcher, ImagesOfTwelveMegapixelsAndOddWidthsAreMatched) {
  for (const cv::Size size : {cv::Size(4096, 3072), cv::Size(4095, 37)}) {
    RectifiedPair pair;
    pair.right.pixels = random_texture(size, 5);
    constexpr int kShift_px = 21;
    pair.left.pixels = cv::Mat1b::zeros(size);
    pair.right.pixels.colRange(0, size.width - kShift_px)
        .copyTo(pair.left.pixels.colRange(kShift_px, size.width));
    const DisparityImage found = match(pair, GetParam(), 2);
    const cv::Mat1b is_right = cv::abs(found.disparity_px - kShift_px) < 0.1F;
    EXPECT_GT(cv::countNonZero(is_right), 0.97 * size.area());
  }
}

TEST_P(CensusMatcher, NoiseBetweenCamerasIsNoSurface) {
  for (const unsigned levels : {2U, 3U, 5U, 16U, 256U}) {
    std::mt19937 random(7);
    const auto gray = [&](int, int) { return static_cast<std::uint8_t>(random() % levels); };
    RectifiedPair pair = pair_of(gray);
    pair.right = pair_of(gray).left;
    EXPECT_LT(density(match(pair, GetParam())), 0.002) << levels << " grey values";
  }
}

// Of blobs of few grey values, independent in both images.
double density_of_blurred_noise(const MatcherParams& params, unsigned levels, double blur_px,
                                unsigned seed) {
  cv::RNG random(seed);
  RectifiedPair pair;
  for (GrayImage* const image : {&pair.left, &pair.right}) {
    image->pixels.create(kSize);
    random.fill(image->pixels, cv::RNG::UNIFORM, 0, levels);
    cv::GaussianBlur(image->pixels, image->pixels, {0, 0}, blur_px);
  }
  return density(match(pair, params));
}

TEST_P(CensusMatcher, BlurredNoiseIsHardlyASurface) {
  constexpr unsigned kSeeds = 6;
  double sum = 0, largest = 0;
  for (const unsigned levels : {2U, 3U, 5U, 256U})
    for (const double blur_px : {0.8, 1.5})
      for (unsigned seed = 1; seed <= kSeeds; ++seed) {
        const double found = density_of_blurred_noise(GetParam(), levels, blur_px, seed);
        sum += found / (8 * kSeeds);
        largest = std::max(largest, found);
      }
  EXPECT_LT(sum, 0.008);
  EXPECT_LT(largest, 0.06);
  RecordProperty("mean", std::to_string(sum));
  RecordProperty("largest", std::to_string(largest));
}

TEST_P(CensusMatcher, StripesThatRepeatAreNoSurface) {
  constexpr int kPeriod_px = 16;
  const RectifiedPair pair =
      pair_of([](int u, int) { return static_cast<std::uint8_t>(u % kPeriod_px * 12); });
  EXPECT_LT(density(match(pair, GetParam())), 0.02);
}

// Shifted by 21 px, which is no multiple of their periods. At the left border only some of the
// disparities that fit lie inside the right image.
TEST_P(CensusMatcher, PatternsThatRepeatAreNoSurface) {
  constexpr int kShift_px = 21;
  using Gray = int (*)(int u, int v);
  for (const Gray gray : {Gray{[](int u, int) { return u % 16 * 12; }},
                          Gray{[](int u, int v) { return (u / 8 + v / 8) % 2 == 0 ? 60 : 190; }},
                          Gray{[](int u, int v) { return (u / 16 + v / 16) % 2 == 0 ? 60 : 190; }},
                          Gray{[](int u, int) { return u / 10 % 2 == 0 ? 70 : 180; }},
                          Gray{[](int u, int) { return 60 + u / 4; }}})
    for (const unsigned noise_gray : {0U, 2U, 5U}) {
      std::mt19937 random(3);
      const auto noisy = [&](int u, int v) {
        return static_cast<std::uint8_t>(gray(u, v) +
                                         static_cast<int>(random() % (noise_gray + 1)));
      };
      RectifiedPair pair = pair_of(noisy);
      pair.right = pair_of([&](int u, int v) { return noisy(u + kShift_px, v); }).left;
      EXPECT_LT(density(match(pair, GetParam())), 0.2)
          << gray(50, 50) << ' ' << gray(60, 50) << " noise " << noise_gray;
    }
}

TEST_P(CensusMatcher, ACameraThatIsHalfAsBrightFindsTheSamePlane) {
  RectifiedPair pair = synthetic_pair(kSize, slanted);
  pair.right.pixels *= 0.5;
  const DisparityImage found = match(pair, GetParam());
  EXPECT_GT(share_right(found, {64, 16, 240, 208}, 0.5), 0.9);
}

TEST_P(CensusMatcher, FloorsAreNotDraggedUpOrDown) {
  const auto floor = [](int, int v) { return 5.0 + 0.12 * v; };
  const DisparityImage found = match(synthetic_pair(kSize, floor), GetParam());
  double sum_px = 0;
  int count = 0;
  for (int v = 40; v < 220; ++v)
    for (int u = 60; u < 300; ++u)
      if (found.disparity_px(v, u) > 0.0F) {
        sum_px += found.disparity_px(v, u) - floor(u, v);
        ++count;
      }
  EXPECT_GT(count, 30000);
  EXPECT_NEAR(sum_px / count, 0.0, 0.05);
}

TEST(SemiGlobalMatching, RefusesPenaltiesInTheWrongOrder) {
  SemiGlobalMatchingParams params;
  params.smoothness_large = params.smoothness_small;
  EXPECT_THROW(match(synthetic_pair(kSize, slanted), params), UsageError);
}

TEST(BlockMatching, RefusesAWindowThatDoesNotFit) {
  EXPECT_THROW(match(synthetic_pair({40, 12}, slanted), BlockMatchingParams{}), Error);
}

TEST(DisparityPicture, IsBlackExactlyWhereThereIsNoDisparity) {
  DisparityImage image{cv::Mat1f(4, 50, 10.0F), cv::Mat1f(4, 50, 1.0F)};
  image.disparity_px.colRange(0, 25).setTo(30.0F);
  image.disparity_px.row(2).setTo(0.0F);
  cv::Mat1b dark;
  cv::inRange(draw_disparity(image), cv::Scalar(0, 0, 0), cv::Scalar(0, 0, 0), dark);
  EXPECT_EQ(cv::countNonZero(dark), 50);
  EXPECT_EQ(cv::countNonZero(dark.row(2)), 50);
}

}  // namespace
}  // namespace stereovox
