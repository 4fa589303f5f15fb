#include "stereovox/stereo/adaptive_window.h"

#include <algorithm>
#include <array>
#include <vector>

#include "stereovox/core/parallel.h"
#include "stereovox/stereo/judge_matches.h"
#include "stereovox/stereo/multiple_windows.h"
#include "stereovox/stereo/smooth_disparities.h"
#include "stereovox/stereo/window_sweep.h"
#include "stereovox/stereo/window_vote.h"

namespace stereovox {
namespace {

// Lower stripes would gather more rows above and below them than their own.
constexpr int kMinStripeHeight_px = 60;
// Whoever votes must be found again from the right image, and stand out.
constexpr VoterParams kVoters = {.min_log_ratio = 8, .max_left_right = kStepsPerPixel};

// Of each support; fitted by scripts/fit_confidence to cones, motorcycle and six frames of a
// rendered room.
constexpr std::array<ConfidenceModel, 4> kModels = {
    {{.bias = 1.184,
      .ratio = 8.418,
      .left_right = 0.422,
      .variance = 0.292,
      .local = 0.0261,
      .candidates = 0.443,
      .right = {0.605, 0.605, 0.636, 0.668, 0.780, 0.902, 0.964, 0.982, 0.984, 0.991, 0.995, 0.996},
      .sigma_px = {0.81, 0.81, 0.73, 0.72, 0.67, 0.53, 0.42, 0.35, 0.29, 0.25, 0.23, 0.21}},
     {.bias = 2.479,
      .ratio = 3.743,
      .left_right = 0.667,
      .variance = 0.389,
      .local = 0.0334,
      .candidates = 0.489,
      .right = {0.545, 0.575, 0.650, 0.760, 0.794, 0.885, 0.954, 0.980, 0.990, 0.993, 0.994, 0.996},
      .sigma_px = {0.81, 0.74, 0.69, 0.67, 0.60, 0.59, 0.45, 0.34, 0.26, 0.22, 0.21, 0.20}},
     {.bias = 2.383,
      .ratio = 4.220,
      .left_right = 0.685,
      .variance = 0.399,
      .local = 0.0372,
      .candidates = 0.442,
      .right = {0.491, 0.547, 0.603, 0.674, 0.754, 0.886, 0.957, 0.980, 0.988, 0.991, 0.991, 0.994},
      .sigma_px = {0.82, 0.76, 0.75, 0.70, 0.67, 0.60, 0.46, 0.33, 0.24, 0.21, 0.21, 0.20}},
     {.bias = 2.318,
      .ratio = 4.313,
      .left_right = 0.690,
      .variance = 0.386,
      .local = 0.0367,
      .candidates = 0.449,
      .right = {0.485, 0.545, 0.607, 0.685, 0.762, 0.891, 0.958, 0.980, 0.988, 0.990, 0.991, 0.994},
      .sigma_px = {0.82, 0.73, 0.74, 0.70, 0.67, 0.60, 0.46, 0.33, 0.24, 0.21, 0.21, 0.20}}}};

const ConfidenceModel& model_of(WindowSupport support) {
  return kModels[static_cast<std::size_t>(support)];
}

MultipleWindows windows_of(const AdaptiveWindowParams& params) {
  const auto neighbours =
      static_cast<int>(params.support) - static_cast<int>(WindowSupport::one_window);
  return {.half_px = params.window_half_px,
          .neighbours = static_cast<NeighbourWindows>(neighbours)};
}

struct Stripe {
  int first_row, end_row;
};

template <class Sweep>
void sweep_rows(Sweep&& sweep, const CensusSearch& search, Stripe stripe, MatchFeatures& features) {
  const int width = features.disparity.cols;
  WinnerRow winners(width);
  FeatureRows rows(width, search.min_disparity_px, search.max_disparity_px());
  for (int v = stripe.first_row; v < stripe.end_row; ++v) {
    sweep.next_row(winners);
    rows.fill(winners, v, features);
  }
}

void sweep_stripe(const CensusPair& pair, const Arms& arms, const AdaptiveWindowParams& params,
                  Stripe stripe, MatchFeatures& features) {
  const CensusSearch& search = params.search;
  const WindowKernels& kernels = fastest_window_kernels();
  if (params.support == WindowSupport::cross)
    sweep_rows(WindowSweep(pair, arms, search.min_disparity_px, search.candidates(),
                           stripe.first_row, kernels),
               search, stripe, features);
  else
    sweep_rows(MultipleWindowSweep(pair, windows_of(params), search.min_disparity_px,
                                   search.candidates(), stripe.first_row, kernels),
               search, stripe, features);
}

}  // namespace

std::span<const std::string> names_of(WindowSupport) {
  static const std::vector<std::string> names = {"cross", "one_window", "five_windows",
                                                 "nine_windows"};
  return names;
}

MatchFeatures match_features(const RectifiedPair& pair, const AdaptiveWindowParams& params,
                             int threads) {
  const CensusPair padded = pad_for_census(equally_exposed(pair));
  const Arms arms = arms_of(pair.left.pixels, {params.max_arm_px, params.arm_contrast_gray},
                            fastest_window_kernels(), threads);
  MatchFeatures features = features_of_size(pair.left.pixels.size());
  // The sums are exact, so it does not matter where stripes begin.
  const int height = padded.height_px;
  const int stripes = std::clamp(height / kMinStripeHeight_px, 1, std::max(threads, 1));
  parallel_for(0, stripes, threads, [&](int i) {
    sweep_stripe(padded, arms, params, {height * i / stripes, height * (i + 1) / stripes},
                 features);
  });
  VoterParams voters = kVoters;
  voters.min_share = params.min_vote_share;
  vote_in_windows(features, arms, pair.valid_left, voters, threads);
  smooth_disparities(features.disparity, threads);
  return features;
}

DisparityImage match(const RectifiedPair& pair, const AdaptiveWindowParams& params, int threads) {
  return judge_matches(pair, match_features(pair, params, threads), params.search,
                       model_of(params.support), threads);
}

}  // namespace stereovox
