// adaptive_window on image pairs with truth. What only one camera sees counts, too.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "stereovox/stereo/adaptive_window.h"

namespace stereovox {
namespace {

constexpr double kTruthStep_px = 1.0 / 256.0;  // KITTI's form

struct DataPair {
  const char* name;
  int disparity_range_px;
  double min_density, max_bad;  // shares
};

class AdaptiveWindowOnPairs : public testing::TestWithParam<DataPair> {};

INSTANTIATE_TEST_SUITE_P(Data, AdaptiveWindowOnPairs,
                         testing::Values(DataPair{"cones", 64, 0.85, 0.05},
                                         DataPair{"teddy", 64, 0.85, 0.045},
                                         DataPair{"motorcycle_q", 96, 0.85, 0.055},
                                         DataPair{"aloe_full", 224, 0.8, 0.025}),
                         [](const auto& pair) { return std::string(pair.param.name); });

struct Tally {
  double known = 0, found = 0, bad = 0, confidence = 0;
};

// Pixels whose truth is known.
Tally tally_of(const DisparityImage& found, const cv::Mat1w& truth) {
  Tally tally;
  for (int v = 0; v < found.height(); ++v)
    for (int u = 0; u < found.width(); ++u) {
      if (truth(v, u) == 0) continue;
      ++tally.known;
      if (!(found.disparity_px(v, u) > 0.0F)) continue;
      ++tally.found;
      tally.confidence += found.confidence(v, u);
      const double error_px = found.disparity_px(v, u) - truth(v, u) * kTruthStep_px;
      tally.bad += std::abs(error_px) > kRightWithin_px ? 1 : 0;
    }
  return tally;
}

TEST_P(AdaptiveWindowOnPairs, IsDenseAndRightAndKnowsHowSureItMayBe) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(STEREOVOX_SHARED_DIR) / "data/stereo_pairs" / GetParam().name;
  if (!fs::exists(folder)) GTEST_SKIP() << folder << " is not there";
  RectifiedPair pair;
  pair.left.pixels = cv::imread(folder / "left.png", cv::IMREAD_GRAYSCALE);
  pair.right.pixels = cv::imread(folder / "right.png", cv::IMREAD_GRAYSCALE);
  const cv::Mat truth = cv::imread(folder / "disp_gt.png", cv::IMREAD_ANYDEPTH);
  ASSERT_EQ(truth.type(), CV_16U);
  AdaptiveWindowParams params;
  params.search.disparity_range_px = GetParam().disparity_range_px;
  const Tally tally = tally_of(match(pair, params, 1), truth);
  const double bad = tally.bad / tally.found;
  EXPECT_GT(tally.found / tally.known, GetParam().min_density);
  EXPECT_LT(bad, GetParam().max_bad);
  EXPECT_NEAR(tally.confidence / tally.found, 1 - bad, 0.03);
  RecordProperty("density", std::to_string(tally.found / tally.known));
  RecordProperty("bad_2", std::to_string(bad));
  RecordProperty("confidence", std::to_string(tally.confidence / tally.found));
}

}  // namespace
}  // namespace stereovox
