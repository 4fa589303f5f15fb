// The confidence and sigma of census_sgm on pairs that its model was not fitted to.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "stereovox/stereo/census_sgm.h"
#include "stereovox/stereo/stereo_pairs_for_test.h"

namespace stereovox {
namespace {

constexpr int kBins = 10;

struct Bin {
  double count = 0, confidence = 0, right = 0, variance_px2 = 0, squared_px2 = 0;
};

struct LeftOutPair {
  const char* name;
  int disparity_range_px;
  double max_calibration_error;
};

class ConfidenceOfCensusSgm : public testing::TestWithParam<LeftOutPair> {};

INSTANTIATE_TEST_SUITE_P(LeftOut, ConfidenceOfCensusSgm,
                         testing::Values(LeftOutPair{"teddy", 64, 0.01},
                                         LeftOutPair{"aloe_full", 224, 0.02}),
                         [](const auto& pair) { return std::string(pair.param.name); });

std::array<Bin, kBins> bins_of(const DisparityImage& found, const cv::Mat1f& truth_image_px) {
  std::array<Bin, kBins> bins;
  for (int v = 0; v < found.height(); ++v)
    for (int u = 0; u < found.width(); ++u) {
      const double truth_px = truth_image_px(v, u);
      if (!(found.disparity_px(v, u) > 0.0F) || truth_px == 0.0) continue;
      const double confidence = found.confidence(v, u), sigma_px = found.sigma_px(v, u);
      const double error_px = found.disparity_px(v, u) - truth_px;
      Bin& bin = bins[std::min(static_cast<int>(confidence * kBins), kBins - 1)];
      ++bin.count;
      bin.confidence += confidence;
      if (std::abs(error_px) > kRightWithin_px) continue;
      ++bin.right;
      bin.variance_px2 += sigma_px * sigma_px;
      bin.squared_px2 += error_px * error_px;
    }
  return bins;
}

TEST_P(ConfidenceOfCensusSgm, IsRightAboutPairsThatWereLeftOutOfTheFit) {
  const auto read = read_pair_with_truth(GetParam().name);
  if (!read) GTEST_SKIP() << folder_of_pair(GetParam().name) << " is not there";
  CensusSgmParams params;
  params.search.disparity_range_px = GetParam().disparity_range_px;
  Bin all;
  double off = 0, too_sure = 0;
  for (const Bin& bin : bins_of(match(read->pair, params, 1), read->truth_px)) {
    off += std::abs(bin.confidence - bin.right);
    too_sure += bin.confidence - bin.right;
    all.count += bin.count;
    all.variance_px2 += bin.variance_px2;
    all.squared_px2 += bin.squared_px2;
  }
  EXPECT_GT(all.count, 0.7 * cv::countNonZero(read->truth_px));
  EXPECT_LE(off / all.count, GetParam().max_calibration_error);
  EXPECT_LE(too_sure / all.count, 0.03) << "more is promised than is kept";
  const double sigma_ratio = std::sqrt(all.squared_px2 / all.variance_px2);
  EXPECT_LT(sigma_ratio, 1.5) << "errors are larger than sigma says";
  EXPECT_GT(sigma_ratio, 1 / 1.5) << "errors are smaller than sigma says";
  RecordProperty("calibration_error", std::to_string(off / all.count));
  RecordProperty("too_sure", std::to_string(too_sure / all.count));
  RecordProperty("sigma_ratio", std::to_string(sigma_ratio));
}

}  // namespace
}  // namespace stereovox
