// adaptive_window on image pairs with truth. What only one camera sees counts, too.
#include <gtest/gtest.h>

#include <cmath>

#include "stereovox/stereo/adaptive_window.h"
#include "stereovox/stereo/stereo_pairs_for_test.h"

namespace stereovox {
namespace {

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
Tally tally_of(const DisparityImage& found, const cv::Mat1f& truth_px) {
  Tally tally;
  for (int v = 0; v < found.height(); ++v)
    for (int u = 0; u < found.width(); ++u) {
      if (truth_px(v, u) == 0.0F) continue;
      ++tally.known;
      if (!(found.disparity_px(v, u) > 0.0F)) continue;
      ++tally.found;
      tally.confidence += found.confidence(v, u);
      const double error_px = found.disparity_px(v, u) - truth_px(v, u);
      tally.bad += std::abs(error_px) > kRightWithin_px ? 1 : 0;
    }
  return tally;
}

TEST_P(AdaptiveWindowOnPairs, IsDenseAndRightAndKnowsHowSureItMayBe) {
  const auto read = read_pair_with_truth(GetParam().name);
  if (!read) GTEST_SKIP() << folder_of_pair(GetParam().name) << " is not there";
  AdaptiveWindowParams params;
  params.search.disparity_range_px = GetParam().disparity_range_px;
  const Tally tally = tally_of(match(read->pair, params, 1), read->truth_px);
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
