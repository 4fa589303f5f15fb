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
    {{.bias = 1.174,
      .ratio = 8.379,
      .left_right = 0.420,
      .variance = 0.297,
      .local = 0.0259,
      .candidates = 0.437,
      .right = {0.108, 0.186, 0.297, 0.423, 0.679, 0.877, 0.961, 0.982, 0.984, 0.991, 0.994, 0.996},
      .sigma_px = {0.84, 0.80, 0.76, 0.73, 0.70, 0.56, 0.46, 0.37, 0.30, 0.26, 0.23, 0.21}},
     {.bias = 2.393,
      .ratio = 3.911,
      .left_right = 0.655,
      .variance = 0.387,
      .local = 0.0334,
      .candidates = 0.477,
      .right = {0.073, 0.144, 0.281, 0.479, 0.638, 0.827, 0.943, 0.979, 0.989, 0.993, 0.994, 0.995},
      .sigma_px = {0.81, 0.75, 0.73, 0.71, 0.66, 0.65, 0.49, 0.35, 0.27, 0.22, 0.21, 0.20}},
     {.bias = 2.367,
      .ratio = 4.285,
      .left_right = 0.676,
      .variance = 0.408,
      .local = 0.0378,
      .candidates = 0.430,
      .right = {0.084, 0.195, 0.292, 0.440, 0.641, 0.848, 0.951, 0.980, 0.988, 0.991, 0.991, 0.994},
      .sigma_px = {0.83, 0.77, 0.78, 0.75, 0.71, 0.65, 0.49, 0.34, 0.24, 0.21, 0.21, 0.20}},
     {.bias = 2.301,
      .ratio = 4.385,
      .left_right = 0.682,
      .variance = 0.394,
      .local = 0.0375,
      .candidates = 0.438,
      .right = {0.084, 0.184, 0.288, 0.447, 0.644, 0.851, 0.951, 0.980, 0.988, 0.990, 0.991, 0.994},
      .sigma_px = {0.83, 0.76, 0.78, 0.74, 0.71, 0.65, 0.49, 0.34, 0.24, 0.21, 0.21, 0.20}}}};

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
