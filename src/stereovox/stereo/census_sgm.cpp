#include "stereovox/stereo/census_sgm.h"

#include <algorithm>
#include <cmath>

#include "stereovox/core/error.h"
#include "stereovox/core/parallel.h"
#include "stereovox/stereo/census_sweep.h"
#include "stereovox/stereo/judge_matches.h"
#include "stereovox/stereo/repetition.h"
#include "stereovox/stereo/smooth_disparities.h"

namespace stereovox {
namespace {

// Stripes of the image are swept independently, each after some rows above it that only warm up its
// paths. Their number follows from the image alone, never from the threads.
constexpr int kStripeHeight_px = 120;
constexpr int kWarmUpRows = 12;

// Fitted by scripts/fit_confidence to cones, motorcycle and six frames of a rendered room.
constexpr ConfidenceModel kModel = {
    .bias = 2.149,
    .ratio = 1.732,
    .left_right = 0.352,
    .variance = 0.488,
    .local = 0.0229,
    .candidates = 0.365,
    .right = {0.597, 0.628, 0.642, 0.674, 0.692, 0.820, 0.952, 0.983, 0.987, 0.989, 0.994, 0.994},
    .sigma_px = {0.80, 0.68, 0.63, 0.64, 0.68, 0.59, 0.44, 0.34, 0.28, 0.23, 0.21, 0.21}};

SweepParams sweep_params(const CensusSgmParams& p) {
  if (p.smoothness_large <= p.smoothness_small)
    throw UsageError("matcher.smoothness_large must exceed matcher.smoothness_small");
  SweepParams sweep{.min_disparity_px = p.search.min_disparity_px,
                    .candidates = p.search.candidates(),
                    .small_penalty = p.smoothness_small,
                    .nearer_penalty = std::min(p.smoothness_nearer, p.smoothness_small),
                    .large_penalty = {}};
  for (std::size_t step = 0; step < sweep.large_penalty.size(); ++step) {
    const double share = p.edge_contrast_gray / (p.edge_contrast_gray + static_cast<double>(step));
    const long penalty = std::lround(p.smoothness_large * share);
    sweep.large_penalty[step] =
        static_cast<std::uint8_t>(std::max<long>(penalty, p.smoothness_small + 1));
  }
  return sweep;
}

// Their best candidate is no better than the second one.
void doubt(const std::vector<PixelSpan>& repeating, int first_row, int end_row,
           MatchFeatures& features) {
  for (const PixelSpan& span : repeating)
    features.log_ratio.rowRange(first_row, end_row).colRange(span.begin, span.end).setTo(0);
}

void sweep_stripe(const CensusPair& pair, const SweepParams& params, int first_row, int end_row,
                  MatchFeatures& features) {
  const int warm_up_row = std::max(0, first_row - kWarmUpRows);
  CensusSweep sweep(pair, params, warm_up_row, fastest_census_kernels());
  for (int v = warm_up_row; v < first_row; ++v) sweep.skip_row();
  std::array<WinnerRow, 2> winners = {WinnerRow(pair.width_px), WinnerRow(pair.width_px)};
  FeatureRows rows(pair.width_px, params.min_disparity_px, params.max_disparity_px());
  RepetitionBand band(pair.width_px, params.candidates);
  for (int begin = first_row; begin < end_row; begin += RepetitionBand::kBlockHeight_px) {
    const int end = std::min(begin + RepetitionBand::kBlockHeight_px, end_row);
    for (int v = begin; v < end; v += 2) {
      sweep.next_rows(winners);
      if ((v - begin) % RepetitionBand::kRowStep_px == 0)
        band.add_row(sweep.costs(), winners[0].candidate.data());
      for (int i = 0; i < std::min(2, end - v); ++i) rows.fill(winners[i], v + i, features);
    }
    doubt(band.take_repeating(), begin, end, features);
  }
}

}  // namespace

MatchFeatures match_features(const RectifiedPair& pair, const CensusSgmParams& params,
                             int threads) {
  const SweepParams sweep = sweep_params(params);
  const CensusPair padded = pad_for_census(equally_exposed(pair));
  const int height = padded.height_px;
  const int stripes = std::max(1, height / kStripeHeight_px);
  MatchFeatures features = features_of_size(pair.left.pixels.size());
  parallel_for(0, stripes, threads, [&](int i) {
    sweep_stripe(padded, sweep, height * i / stripes, height * (i + 1) / stripes, features);
  });
  smooth_disparities(features.disparity, threads);
  return features;
}

DisparityImage match(const RectifiedPair& pair, const CensusSgmParams& params, int threads) {
  return judge_matches(pair, match_features(pair, params, threads), params.search, kModel, threads);
}

}  // namespace stereovox
