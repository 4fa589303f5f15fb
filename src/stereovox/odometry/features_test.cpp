#include "stereovox/odometry/features.h"

#include <gtest/gtest.h>

#include <random>

namespace stereovox {
namespace {

constexpr int kWidth = 160, kHeight = 120;

// Bright squares of 6 x 6 pixels on a dark ground, one every 20 pixels.
GrayImage squares() {
  GrayImage image{cv::Mat1b(kHeight, kWidth, std::uint8_t{40})};
  for (int v = 10; v + 10 < kHeight; v += 20)
    for (int u = 10; u + 10 < kWidth; u += 20) image.pixels(cv::Rect(u, v, 6, 6)) = 200;
  return image;
}

DisparityImage disparity_everywhere(float disparity_px) {
  return {cv::Mat1f(kHeight, kWidth, disparity_px), cv::Mat1f(kHeight, kWidth, 0.35F)};
}

RectifiedPair pair_of(const GrayImage& image) {
  RectifiedPair pair;
  pair.left = pair.right = image;
  return pair;
}

TEST(Features, LieAtCornersAndAreSpreadOverTheImage) {
  const FeatureSet set = extract_features(pair_of(squares()), disparity_everywhere(8.0F), {});
  EXPECT_GT(set.features.size(), 48U);
  EXPECT_EQ(set.features.size(), set.descriptors.size());
  for (const Feature& feature : set.features) {
    const int u = static_cast<int>(feature.pixel.x()) % 20;
    const int v = static_cast<int>(feature.pixel.y()) % 20;
    EXPECT_TRUE(u >= 9 && u <= 16 && v >= 9 && v <= 16) << feature.pixel.transpose();
    EXPECT_EQ(feature.disparity_px, 8.0);
  }
}

TEST(Features, AreNotMoreThanAskedFor) {
  FeatureParams params;
  params.max_count = 20;
  const auto set = extract_features(pair_of(squares()), disparity_everywhere(8.0F), params);
  EXPECT_LE(set.features.size(), 20U);
  EXPECT_GT(set.features.size(), 10U);
}

TEST(Features, NeedADisparity) {
  DisparityImage disparity = disparity_everywhere(8.0F);
  disparity.disparity_px.colRange(0, 80) = 0.0F;
  for (const Feature& f : extract_features(pair_of(squares()), disparity, {}).features)
    EXPECT_GE(f.pixel.x(), 79.0);
}

TEST(Features, StayInTheValidPartOfTheImage) {
  RectifiedPair pair = pair_of(squares());
  pair.valid_left = cv::Mat1b(kHeight, kWidth, std::uint8_t{255});
  pair.valid_left.rowRange(60, kHeight) = 0;
  const FeatureSet set = extract_features(pair, disparity_everywhere(8.0F), {});
  EXPECT_FALSE(set.features.empty());
  for (const Feature& f : set.features) EXPECT_LT(f.pixel.y(), 60.0);
}

TEST(Features, OneWrongPixelDoesNotSpoilTheDisparity) {
  DisparityImage disparity = disparity_everywhere(8.0F);
  for (int v = 0; v < kHeight; v += 2)
    for (int u = 0; u < kWidth; u += 2) disparity.disparity_px(v, u) = 40.0F;
  for (const Feature& f : extract_features(pair_of(squares()), disparity, {}).features)
    EXPECT_EQ(f.disparity_px, 8.0);
}

TEST(Features, NoneInAnImageWithoutTextureOrSmallerThanAPatch) {
  const GrayImage flat{cv::Mat1b(kHeight, kWidth, std::uint8_t{90})};
  EXPECT_TRUE(extract_features(pair_of(flat), disparity_everywhere(8.0F), {}).features.empty());
  const GrayImage tiny{cv::Mat1b(8, 8, std::uint8_t{90})};
  const DisparityImage none{cv::Mat1f(8, 8, 0.0F), cv::Mat1f(8, 8, 0.0F)};
  EXPECT_TRUE(extract_features(pair_of(tiny), none, {}).features.empty());
}

TEST(Features, DescriptorsDoNotChangeWithBrightnessAndContrast) {
  const GrayImage image = squares();
  GrayImage dimmed;
  cv::Mat(image.pixels * 0.5 + 20).copyTo(dimmed.pixels);
  const auto a = extract_features(pair_of(image), disparity_everywhere(8.0F), {});
  const auto b = extract_features(pair_of(dimmed), disparity_everywhere(8.0F), {});
  ASSERT_EQ(a.features.size(), b.features.size());
  for (std::size_t i = 0; i < a.features.size(); ++i) {
    EXPECT_EQ(a.features[i].pixel, b.features[i].pixel);
    EXPECT_NEAR(correlation(a.descriptors[i], b.descriptors[i]), 1.0, 0.01);
  }
}

}  // namespace
}  // namespace stereovox
