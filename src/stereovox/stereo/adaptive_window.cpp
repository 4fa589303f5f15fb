#include "stereovox/stereo/adaptive_window.h"

#include <algorithm>

#include "stereovox/core/parallel.h"
#include "stereovox/stereo/judge_matches.h"
#include "stereovox/stereo/smooth_disparities.h"
#include "stereovox/stereo/window_sweep.h"
#include "stereovox/stereo/window_vote.h"

namespace stereovox {
namespace {

// Lower stripes would gather more rows above and below them than their own.
constexpr int kMinStripeHeight_px = 60;
// Whoever votes must be found again from the right image, and stand out.
constexpr VoterParams kVoters = {.min_log_ratio = 8, .max_left_right = kStepsPerPixel};

// Fitted by scripts/fit_confidence to cones, motorcycle and six frames of a rendered room.
constexpr ConfidenceModel kModel = {
    .bias = 1.479,
    .ratio = 9.257,
    .left_right = 0.365,
    .variance = 0.292,
    .local = 0.0352,
    .candidates = 0.410,
    .right = {0.098, 0.164, 0.297, 0.432, 0.674, 0.886, 0.962, 0.980, 0.983, 0.991, 0.995, 0.997},
    .sigma_px = {0.91, 0.83, 0.81, 0.79, 0.70, 0.57, 0.45, 0.36, 0.29, 0.25, 0.22, 0.19}};

void sweep_stripe(const CensusPair& pair, const Arms& arms, const CensusSearch& search,
                  int first_row, int end_row, MatchFeatures& features) {
  WindowSweep sweep(pair, arms, search.min_disparity_px, search.candidates(), first_row,
                    fastest_window_kernels());
  WinnerRow winners(pair.width_px);
  FeatureRows rows(pair.width_px, search.min_disparity_px, search.max_disparity_px());
  for (int v = first_row; v < end_row; ++v) {
    sweep.next_row(winners);
    rows.fill(winners, v, features);
  }
}

}  // namespace

MatchFeatures match_features(const RectifiedPair& pair, const AdaptiveWindowParams& params,
                             int threads) {
  const CensusPair padded = pad_for_census(pair);
  const Arms arms = arms_of(pair.left.pixels, {params.max_arm_px, params.arm_contrast_gray},
                            fastest_window_kernels(), threads);
  MatchFeatures features = features_of_size(pair.left.pixels.size());
  // The sums are exact, so it does not matter where stripes begin.
  const int height = padded.height_px;
  const int stripes = std::clamp(height / kMinStripeHeight_px, 1, std::max(threads, 1));
  parallel_for(0, stripes, threads, [&](int i) {
    sweep_stripe(padded, arms, params.search, height * i / stripes, height * (i + 1) / stripes,
                 features);
  });
  VoterParams voters = kVoters;
  voters.min_share = params.min_vote_share;
  vote_in_windows(features, arms, pair.valid_left, voters, threads);
  smooth_disparities(features.disparity, threads);
  return features;
}

DisparityImage match(const RectifiedPair& pair, const AdaptiveWindowParams& params, int threads) {
  return judge_matches(pair, match_features(pair, params, threads), params.search, kModel, threads);
}

}  // namespace stereovox
