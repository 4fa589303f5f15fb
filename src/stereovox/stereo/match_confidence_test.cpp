#include "stereovox/stereo/match_confidence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <random>
#include <vector>

namespace stereovox {
namespace {

constexpr ConfidenceModel kModel = {
    .bias = 2.0,
    .ratio = 1.5,
    .left_right = 0.5,
    .variance = 0.25,
    .local = 0.02,
    .candidates = 0.5,
    .right = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.97, 0.99},
    .sigma_px = {1.2, 1.1, 1.0, 0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2, 0.1}};

MatchFeatures features_of(const cv::Mat1s& disparity) {
  MatchFeatures features{disparity, cv::Mat1b(disparity.size(), 0), cv::Mat1b(disparity.size(), 0),
                         cv::Mat1b(disparity.size(), 0)};
  return features;
}

Credence credence_at(const MatchFeatures& features, int v, int u) {
  const CredenceTable table(kModel, 64);
  std::vector<std::uint8_t> levels(features.disparity.cols);
  table.fill_level_row(features, v, levels.data());
  return table.at(levels[u]);
}

TEST(MatchConfidence, TheVarianceIsThatOfTheNeighbourhood) {
  std::mt19937 random(3);
  cv::Mat1s disparity(9, 11);
  for (std::int16_t& d : disparity)
    d = static_cast<std::int16_t>(static_cast<int>(random() % 1000) * 8 - 2000);
  std::vector<float> variance_px2(11);
  for (const int v : {0, 4, 8}) {
    fill_variance_row(disparity, v, variance_px2.data());
    for (int u = 0; u < 11; ++u) {
      double sum = 0, squares = 0;
      for (int dv = -2; dv <= 2; ++dv)
        for (int du = -2; du <= 2; ++du) {
          const double d_px = disparity(std::clamp(v + dv, 0, 8), std::clamp(u + du, 0, 10)) / 32.0;
          sum += d_px / 25;
          squares += d_px * d_px / 25;
        }
      EXPECT_NEAR(variance_px2[u], squares - sum * sum, 0.01) << v << " " << u;
    }
  }
}

TEST(MatchConfidence, TheLogarithmOfTheVarianceIsWithinATenth) {
  for (double variance = 0; variance < 400; variance = 1.3 * variance + 0.1)
    EXPECT_NEAR(log_of_raised_variance(static_cast<float>(variance)), std::log2(1 + variance),
                0.09);
  EXPECT_EQ(log_of_raised_variance(1e9F), log_of_raised_variance(kMaxVariance_px2));
}

// Level and flat: logit = bias, 2.0, which is the end of bin 5 and the start of bin 6.
TEST(MatchConfidence, LiesBetweenTheBinsOfTheModel) {
  const Credence credence = credence_at(features_of(cv::Mat1s(5, 5, 320)), 2, 2);
  EXPECT_NEAR(credence.confidence, 0.65, 0.005);
  EXPECT_NEAR(credence.sigma_px, 0.65, 0.005);
}

TEST(MatchConfidence, EachFeatureCountsAsTheModelSays) {
  const auto confidence_with = [](auto change) {
    MatchFeatures features = features_of(cv::Mat1s(5, 5, 320));
    change(features);
    return credence_at(features, 2, 2).confidence;
  };
  EXPECT_NEAR(confidence_with([](auto& f) { f.log_ratio.setTo(kLogRatioSteps); }), 0.80, 0.01);
  EXPECT_NEAR(confidence_with([](auto& f) { f.left_right.setTo(2 * kStepsPerPixel); }), 0.55, 0.01);
  EXPECT_NEAR(confidence_with([](auto& f) { f.local_cost.setTo(100); }), 0.45, 0.01);
  // 24 of 25 px^2 times 2^2 / 25: a variance of 3.84 px^2 from one pixel that is 10 px off.
  EXPECT_NEAR(confidence_with([](auto& f) { f.disparity(2, 2) += 10 * kStepsPerPixel; }),
              0.65 - 0.1 * 0.25 * log_of_raised_variance(3.84F), 0.01);
}

TEST(MatchConfidence, TheFirstLevelOfAConfidenceIsSureEnough) {
  const CredenceTable table(kModel, 64);
  EXPECT_EQ(table.first_level_of(0.0), 0);
  EXPECT_EQ(table.first_level_of(1.0), CredenceTable::kLevels);
  const int level = table.first_level_of(0.5);
  EXPECT_GE(table.at(level).confidence, 0.5F);
  EXPECT_LT(table.at(level - 1).confidence, 0.5F);
}

}  // namespace
}  // namespace stereovox
