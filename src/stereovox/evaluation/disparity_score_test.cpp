#include "stereovox/evaluation/disparity_score.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/core.hpp>

#include "stereovox/core/error.h"

namespace stereovox {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

DisparityImage row_of(const std::vector<float>& disparity_px) {
  return {cv::Mat1f(disparity_px, true).reshape(1, 1), {}};
}

// Errors 0.4, 0.6, 1.5, 2.5, 4 (small against 100), 4 px; one missing pixel; two without truth.
const DisparityImage kTrueDisparity = row_of({10, 10, 10, 10, 100, 20, 10, 0, kInfinity});
const DisparityImage kEstimate = row_of({10.4F, 9.4F, 11.5F, 7.5F, 104, 24, 0, 7, 7});

TEST(DisparityScore, CountsMissingPixelsAsBad) {
  const DisparityScore s = score_disparity(kTrueDisparity, kEstimate);
  EXPECT_EQ(s.counted_px, 7);
  EXPECT_DOUBLE_EQ(s.density_percent, 100.0 * 6 / 7);
  EXPECT_DOUBLE_EQ(s.missing_is_bad.bad_percent[0], 100.0 * 6 / 7);
  EXPECT_DOUBLE_EQ(s.missing_is_bad.bad_percent[1], 100.0 * 5 / 7);
  EXPECT_DOUBLE_EQ(s.missing_is_bad.bad_percent[2], 100.0 * 4 / 7);
  EXPECT_DOUBLE_EQ(s.missing_is_bad.bad_percent[3], 100.0 * 3 / 7);
  EXPECT_DOUBLE_EQ(s.missing_is_bad.d1_percent, 100.0 * 2 / 7);
}

TEST(DisparityScore, OrLeavesThemOut) {
  const DisparityScore s = score_disparity(kTrueDisparity, kEstimate);
  EXPECT_DOUBLE_EQ(s.valid_only.bad_percent[0], 100.0 * 5 / 6);
  EXPECT_DOUBLE_EQ(s.valid_only.bad_percent[3], 100.0 * 2 / 6);
  EXPECT_DOUBLE_EQ(s.valid_only.d1_percent, 100.0 * 1 / 6);
}

TEST(DisparityScore, AveragesTheErrorsOfValidPixels) {
  const DisparityScore s = score_disparity(kTrueDisparity, kEstimate);
  EXPECT_NEAR(s.mae_px, (0.4 + 0.6 + 1.5 + 2.5 + 4 + 4) / 6, 1e-6);
  EXPECT_NEAR(s.rms_px, std::sqrt((0.16 + 0.36 + 2.25 + 6.25 + 16 + 16) / 6), 1e-6);
  EXPECT_NEAR(s.bias_px, (0.4 - 0.6 + 1.5 - 2.5 + 4 + 4) / 6, 1e-6);
}

TEST(DisparityScore, TheMaskRestrictsWhatIsCounted) {
  cv::Mat1b counted(1, 9, static_cast<uchar>(0));
  counted(0, 1) = 255;
  const DisparityScore s = score_disparity(kTrueDisparity, kEstimate, counted);
  EXPECT_EQ(s.counted_px, 1);
  EXPECT_NEAR(s.mae_px, 0.6, 1e-6);
}

TEST(DisparityScore, NonsenseInTheEstimateIsAMissingPixel) {
  const DisparityScore s =
      score_disparity(row_of({5, 5, 5, 5}), row_of({5, -1, kInfinity, std::nanf("")}));
  EXPECT_DOUBLE_EQ(s.density_percent, 25.0);
  EXPECT_DOUBLE_EQ(s.rms_px, 0.0);
}

TEST(DisparityScore, AnEmptyEstimateIsAllBadAndHasNoErrors) {
  const DisparityScore s = score_disparity(row_of({5, 5}), row_of({0, 0}));
  EXPECT_DOUBLE_EQ(s.missing_is_bad.d1_percent, 100.0);
  EXPECT_DOUBLE_EQ(s.valid_only.d1_percent, 0.0);
  EXPECT_DOUBLE_EQ(s.mae_px, 0.0);
}

std::string complaint_of(const DisparityImage& truth, const DisparityImage& estimate) {
  try {
    score_disparity(truth, estimate);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(DisparityScore, ImagesThatCannotBeComparedAreErrors) {
  EXPECT_EQ(complaint_of(row_of({1, 2}), row_of({1, 2, 3})),
            "disparity: the estimate is 3 x 1, the truth 2 x 1");
  EXPECT_EQ(complaint_of(row_of({0, 0}), row_of({1, 2})),
            "disparity: no pixel with truth to compare");
}

// A near bar (pixels 20 to 24, disparity 10) before a wall (disparity 2): seen from the right it
// lies 8 pixels farther to the left before the wall, and hides five of its pixels. What leaves the
// right image is not seen either.
TEST(DisparityScore, PixelsThatTheRightCameraDoesNotSeeAreOccluded) {
  std::vector<float> left(30, 2.0F), right(30, 2.0F);
  std::fill_n(left.begin() + 20, 5, 10.0F);
  std::fill_n(right.begin() + 10, 5, 10.0F);
  const auto two_rows = [](const std::vector<float>& row) {
    return DisparityImage{cv::repeat(row_of(row).disparity_px, 2, 1), {}};
  };
  const cv::Mat1b seen = non_occluded(two_rows(left), two_rows(right));
  for (int v = 0; v < 2; ++v) {
    std::string drawn;
    for (int u = 0; u < seen.cols; ++u) drawn += seen(v, u) == 255 ? '.' : '#';
    EXPECT_EQ(drawn, "##..........#####.............");
  }
}

// From the left image alone the bar's neighbours count as hidden, too: within a pixel of it.
TEST(DisparityScore, TheLeftTruthAloneTellsWhatIsHidden) {
  DisparityImage left = row_of(std::vector<float>(30, 2.0F));
  left.disparity_px.colRange(20, 25).setTo(10.0F);
  left.disparity_px(0, 28) = 0.0F;
  const cv::Mat1b seen = non_occluded(left);
  std::string drawn;
  for (int u = 0; u < seen.cols; ++u) drawn += seen(0, u) == 255 ? '.' : '#';
  EXPECT_EQ(drawn, "##.........#######..........#.");
}

}  // namespace
}  // namespace stereovox
