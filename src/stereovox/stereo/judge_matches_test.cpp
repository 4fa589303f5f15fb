#include "stereovox/stereo/judge_matches.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

namespace stereovox {
namespace {

constexpr int kWidth = 12, kMaxDisparity_px = 7;

// Every pixel has this disparity; the local costs are those of a vertex at the candidate.
WinnerRow winners_at(int disparity_px) {
  WinnerRow row(kWidth);
  std::ranges::fill(row.candidate, static_cast<std::uint8_t>(kMaxDisparity_px - disparity_px));
  std::ranges::fill(row.cost, std::uint8_t{10});
  std::ranges::fill(row.second, std::uint8_t{30});
  std::ranges::fill(row.local, std::uint8_t{5});
  std::ranges::fill(row.local_before, std::uint8_t{20});
  std::ranges::fill(row.local_after, std::uint8_t{20});
  return row;
}

MatchFeatures features_of(const WinnerRow& winners) {
  MatchFeatures features = features_of_size({kWidth, 1});
  FeatureRows(kWidth, 0, kMaxDisparity_px).fill(winners, 0, features);
  return features;
}

TEST(FeatureRows, TheVertexOfTheParabolaIsTheDisparity) {
  WinnerRow winners = winners_at(3);
  winners.local_after[4] = 5;              // towards smaller disparities, by half a pixel
  winners.local_before[5] = kNoLocalCost;  // no neighbour, no vertex
  winners.local_after[6] = 4;              // no minimum, no vertex
  const MatchFeatures features = features_of(winners);
  EXPECT_EQ(features.disparity(0, 3), 3 * kStepsPerPixel);
  EXPECT_EQ(features.disparity(0, 4), 3 * kStepsPerPixel - kStepsPerPixel / 2);
  EXPECT_EQ(features.disparity(0, 5), 3 * kStepsPerPixel);
  EXPECT_EQ(features.disparity(0, 6), 3 * kStepsPerPixel);
}

TEST(FeatureRows, LeftAndRightAgreeOnASurfaceThatTheRightImageShows) {
  const MatchFeatures features = features_of(winners_at(3));
  for (int u = 3; u < kWidth; ++u) EXPECT_EQ(features.left_right(0, u), 0) << u;
  EXPECT_EQ(features.left_right(0, 1), kMaxLeftRight) << "reaches outside the right image";
}

TEST(FeatureRows, WhoLosesItsRightPixelToABetterMatchDiffersFromIt) {
  WinnerRow winners = winners_at(3);
  for (const int u : {8, 9}) {  // right pixels 3 and 4, which pixels 6 and 7 match, too
    winners.candidate[u] = kMaxDisparity_px - 5;
    winners.cost[u] = 9;
  }
  const MatchFeatures features = features_of(winners);
  EXPECT_EQ(features.left_right(0, 8), 0);
  EXPECT_EQ(features.left_right(0, 6), 2 * kStepsPerPixel);
}

TEST(FeatureRows, TheRatioIsThatOfTheSecondBestToTheBest) {
  WinnerRow winners = winners_at(3);
  winners.cost[2] = 0;
  winners.second[2] = 255;
  winners.second[3] = winners.cost[3];
  const MatchFeatures features = features_of(winners);
  EXPECT_NEAR(features.log_ratio(0, 4), kLogRatioSteps * std::log(31.0 / 11.0), 1.0);
  EXPECT_EQ(features.log_ratio(0, 2), kMaxLogRatio);
  EXPECT_EQ(features.log_ratio(0, 3), 0);
}

constexpr ConfidenceModel kSure = {.bias = 6.0,
                                   .ratio = 1.0,
                                   .left_right = 0.0,
                                   .variance = 0.0,
                                   .local = 0.0,
                                   .candidates = 0.0,
                                   .right = {0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1},
                                   .sigma_px = {1, 1, 1, 1, 1, 1, 1, 1, 0.5, 0.5, 0.5, 0.5}};

class JudgedMatches : public testing::Test {
 protected:
  JudgedMatches() {
    pair.left.pixels = pair.right.pixels = cv::Mat1b(1, kWidth, std::uint8_t{0});
    search.speckle_size_px = 0;
  }
  int found(int u) const {
    const DisparityImage image = judge_matches(pair, features, search, kSure, 1);
    EXPECT_EQ(image.disparity_px(0, u) > 0, image.sigma_px(0, u) > 0);
    EXPECT_EQ(image.disparity_px(0, u) > 0, image.confidence(0, u) > 0);
    return image.disparity_px(0, u) > 0 ? 1 : 0;
  }

  RectifiedPair pair;
  CensusSearch search;
  MatchFeatures features = features_of(winners_at(3));
};

TEST_F(JudgedMatches, PassWhenNothingSpeaksAgainstThem) { EXPECT_TRUE(found(6)); }

TEST_F(JudgedMatches, OnesThatReachOutsideTheRightImageFail) {
  EXPECT_TRUE(found(3));
  EXPECT_FALSE(found(2));
}

TEST_F(JudgedMatches, OnesThatAreNotPositiveFail) {
  features.disparity(0, 6) = 0;
  features.disparity(0, 7) = -kStepsPerPixel;
  EXPECT_FALSE(found(6));
  EXPECT_FALSE(found(7));
}

TEST_F(JudgedMatches, AmbiguousOnesFail) {
  search.uniqueness_ratio_percent = 10;
  EXPECT_TRUE(found(6));
  features.log_ratio(0, 6) = 3;
  EXPECT_FALSE(found(6));
}

TEST_F(JudgedMatches, OnesThatTheRightImageContradictsFail) {
  features.left_right(0, 6) = static_cast<std::uint8_t>(kMaxLeftRight);
  EXPECT_FALSE(found(6));
}

TEST_F(JudgedMatches, OnesOfLittleConfidenceFail) {
  ConfidenceModel doubtful = kSure;
  doubtful.bias = -6.0;
  EXPECT_EQ(cv::countNonZero(judge_matches(pair, features, search, doubtful, 1).disparity_px), 0);
}

TEST_F(JudgedMatches, OnesThatACameraDidNotRecordFail) {
  pair.valid_left = cv::Mat1b(1, kWidth, 255);
  pair.valid_right = cv::Mat1b(1, kWidth, 255);
  pair.valid_left(0, 6) = 0;
  pair.valid_right(0, 5) = 0;
  EXPECT_FALSE(found(6));
  EXPECT_FALSE(found(8)) << "the right image has nothing there";
  EXPECT_TRUE(found(7));
}

TEST_F(JudgedMatches, OnesInTheMiddleOfGlareFail) {
  pair.left.pixels = cv::Mat1b(3, kWidth, std::uint8_t{255});
  MatchFeatures rows = features_of_size(pair.left.pixels.size());
  for (int v = 0; v < 3; ++v) {
    features.disparity.copyTo(rows.disparity.row(v));
    features.log_ratio.copyTo(rows.log_ratio.row(v));
    features.left_right.copyTo(rows.left_right.row(v));
    features.local_cost.copyTo(rows.local_cost.row(v));
  }
  pair.left.pixels(2, 7) = 254;
  const DisparityImage image = judge_matches(pair, rows, search, kSure, 1);
  EXPECT_EQ(image.disparity_px(1, 6), 0.0F);
  EXPECT_GT(image.disparity_px(1, 7), 0.0F) << "a pixel below it shows something";
}

TEST_F(JudgedMatches, IslandsWithoutEnoughSurePixelsFail) {
  search.speckle_size_px = 9;
  EXPECT_TRUE(found(6)) << "nine pixels reach into the right image";
  search.speckle_size_px = 10;
  EXPECT_FALSE(found(6));
}

TEST_F(JudgedMatches, EdgesAreSettled) {
  features.disparity(0, 6) = kStepsPerPixel;
  EXPECT_EQ(judge_matches(pair, features, search, kSure, 1).disparity_px(0, 6), 3.0F);
}

TEST_F(JudgedMatches, ThatAreSettledOutsideTheRightImageFail) {
  features.disparity.setTo(4 * kStepsPerPixel);
  features.disparity(0, 3) = kStepsPerPixel;
  EXPECT_FALSE(found(3));
  EXPECT_TRUE(found(4));
}

}  // namespace
}  // namespace stereovox
