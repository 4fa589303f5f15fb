// The confidence and sigma of census_sgm on pairs that its model was not fitted to.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "stereovox/stereo/census_sgm.h"

namespace stereovox {
namespace {

constexpr int kBins = 10;
constexpr double kTruthStep_px = 1.0 / 256.0;  // KITTI's form

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
                         testing::Values(LeftOutPair{"teddy", 64, 0.03},
                                         LeftOutPair{"aloe_full", 224, 0.03}),
                         [](const auto& pair) { return std::string(pair.param.name); });

std::array<Bin, kBins> bins_of(const DisparityImage& found, const cv::Mat& truth) {
  std::array<Bin, kBins> bins;
  for (int v = 0; v < found.height(); ++v)
    for (int u = 0; u < found.width(); ++u) {
      const double truth_px = truth.at<std::uint16_t>(v, u) * kTruthStep_px;
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
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(STEREOVOX_SHARED_DIR) / "data/stereo_pairs" / GetParam().name;
  if (!fs::exists(folder)) GTEST_SKIP() << folder << " is not there";
  RectifiedPair pair;
  pair.left.pixels = cv::imread(folder / "left.png", cv::IMREAD_GRAYSCALE);
  pair.right.pixels = cv::imread(folder / "right.png", cv::IMREAD_GRAYSCALE);
  const cv::Mat truth = cv::imread(folder / "disp_gt.png", cv::IMREAD_ANYDEPTH);
  ASSERT_EQ(truth.type(), CV_16U);
  CensusSgmParams params;
  params.search.disparity_range_px = GetParam().disparity_range_px;
  Bin all;
  double off = 0, too_sure = 0;
  for (const Bin& bin : bins_of(match(pair, params, 1), truth)) {
    off += std::abs(bin.confidence - bin.right);
    too_sure += bin.confidence - bin.right;
    all.count += bin.count;
    all.variance_px2 += bin.variance_px2;
    all.squared_px2 += bin.squared_px2;
  }
  EXPECT_GT(all.count, 0.7 * cv::countNonZero(truth));
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
