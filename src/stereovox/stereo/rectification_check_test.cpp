#include "stereovox/stereo/rectification_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "stereovox/core/error.h"
#include "stereovox/stereo/synthetic_pair_for_test.h"

namespace stereovox {
namespace {

RectificationCheck check(const RectifiedPair& pair) {
  return summarize({measure_corner_offsets(pair)});
}

RectifiedPair pair_with_vertical_offset(double offset_px) {
  return synthetic_pair(
      {320, 240}, [](int u, int v) { return 8.0 + 0.02 * u + 0.02 * v; }, offset_px);
}

std::string refusal_of(const RectificationCheck& result) {
  try {
    judge(result, RectificationParams{}, "data");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(RectificationCheck, MeasuresTheVerticalOffsetToATenthOfAPixel) {
  for (const double offset_px : {0.0, 0.4, -1.0, 3.0}) {
    const RectificationCheck result = check(pair_with_vertical_offset(offset_px));
    EXPECT_GT(result.corners, 50);
    EXPECT_NEAR(result.vertical_px, std::abs(offset_px), 0.1);
    EXPECT_FALSE(result.looks_swapped());
  }
}

TEST(RectificationCheck, AcceptsWarnsAndRefusesByTheOffset) {
  const RectificationParams params;
  EXPECT_EQ(judge(check(pair_with_vertical_offset(0.1)), params, "data"), "");
  EXPECT_THAT(judge(check(pair_with_vertical_offset(0.8)), params, "data"),
              testing::StartsWith("rectification is poor: matched corners differ by 0.8"));
  EXPECT_THAT(refusal_of(check(pair_with_vertical_offset(3.0))),
              testing::StartsWith("data: images are not rectified: matched corners differ by 3.0"));
}

TEST(RectificationCheck, RefusesARolledCamera) {
  RectifiedPair pair = pair_with_vertical_offset(0.0);
  const cv::Mat roll = cv::getRotationMatrix2D({160.0F, 120.0F}, 2.0, 1.0);
  cv::warpAffine(pair.right.pixels.clone(), pair.right.pixels, roll, pair.right.pixels.size());
  EXPECT_THAT(refusal_of(check(pair)), testing::HasSubstr("images are not rectified"));
}

TEST(RectificationCheck, RecognisesSwappedImages) {
  RectifiedPair pair = pair_with_vertical_offset(0.0);
  std::swap(pair.left, pair.right);
  EXPECT_THAT(refusal_of(check(pair)),
              testing::HasSubstr("left and right images look swapped: 100 % of "));
}

TEST(RectificationCheck, SaysWhenItCannotTell) {
  RectifiedPair pair;
  pair.left.pixels = pair.right.pixels = cv::Mat1b(240, 320, 128);
  EXPECT_EQ(judge(check(pair), RectificationParams{}, "data"),
            "rectification could not be checked: only 0 corners were matched");
}

}  // namespace
}  // namespace stereovox
