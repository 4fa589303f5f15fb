#include "stereovox/stereo/census_sgm.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "stereovox/core/error.h"
#include "stereovox/core/parallel.h"
#include "stereovox/stereo/census_sweep.h"
#include "stereovox/stereo/judge_matches.h"

namespace stereovox {
namespace {

// Stripes of the image are swept independently, each after some rows above it that only warm up its
// paths. Their number follows from the image alone, never from the threads.
constexpr int kStripeHeight_px = 120;
constexpr int kWarmUpRows = 12;
constexpr int kMedian_px = 3;  // side of the window that single wrong disparities vanish in

// Fitted by apps/fit_confidence to cones, motorcycle and six frames of a rendered room. The last
// three bins were not reached.
constexpr ConfidenceModel kModel = {
    .bias = 1.838,
    .ratio = 1.357,
    .left_right = 0.704,
    .variance = 0.598,
    .sigma_px = {0.94, 0.93, 0.91, 0.78, 0.76, 0.79, 0.52, 0.34, 0.23, 0.23, 0.23, 0.23}};

SweepParams sweep_params(const CensusSgmParams& p) {
  if (p.smoothness_large <= p.smoothness_small)
    throw UsageError("matcher.smoothness_large must exceed matcher.smoothness_small");
  SweepParams sweep{.min_disparity_px = p.search.min_disparity_px,
                    .candidates = p.search.candidates(),
                    .small_penalty = p.smoothness_small,
                    .large_penalty = {}};
  for (std::size_t step = 0; step < sweep.large_penalty.size(); ++step) {
    const double share = p.edge_contrast_gray / (p.edge_contrast_gray + static_cast<double>(step));
    const long penalty = std::lround(p.smoothness_large * share);
    sweep.large_penalty[step] =
        static_cast<std::uint8_t>(std::max<long>(penalty, p.smoothness_small + 1));
  }
  return sweep;
}

void sweep_stripe(const CensusPair& pair, const SweepParams& params, int first_row, int end_row,
                  MatchFeatures& features) {
  const int warm_up_row = std::max(0, first_row - kWarmUpRows);
  CensusSweep sweep(pair, params, warm_up_row, fastest_census_kernels());
  for (int v = warm_up_row; v < first_row; ++v) sweep.skip_row();
  WinnerRow winners(pair.width_px);
  for (int v = first_row; v < end_row; ++v) {
    sweep.next_row(winners);
    fill_feature_row(winners, params.max_disparity_px(), v, features);
  }
}

}  // namespace

MatchFeatures match_features(const RectifiedPair& pair, const CensusSgmParams& params,
                             int threads) {
  const SweepParams sweep = sweep_params(params);
  const CensusPair padded = pad_for_census(pair);
  const int height = padded.height_px;
  const int stripes = std::max(1, height / kStripeHeight_px);
  MatchFeatures features = features_of_size(pair.left.pixels.size());
  parallel_for(0, stripes, threads, [&](int i) {
    sweep_stripe(padded, sweep, height * i / stripes, height * (i + 1) / stripes, features);
  });
  cv::medianBlur(features.disparity_px, features.disparity_px, kMedian_px);
  parallel_for(0, height, threads, [&](int v) { fill_variance_row(features, v); });
  return features;
}

DisparityImage match(const RectifiedPair& pair, const CensusSgmParams& params, int threads) {
  return judge_matches(pair, match_features(pair, params, threads), params.search, kModel, threads);
}

}  // namespace stereovox
