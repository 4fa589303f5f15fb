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
    {{.bias = 1.479,
      .ratio = 9.257,
      .left_right = 0.365,
      .variance = 0.292,
      .local = 0.0352,
      .candidates = 0.410,
      .right = {0.098, 0.164, 0.297, 0.432, 0.674, 0.886, 0.962, 0.980, 0.983, 0.991, 0.995, 0.997},
      .sigma_px = {0.91, 0.83, 0.81, 0.79, 0.70, 0.57, 0.45, 0.36, 0.29, 0.25, 0.22, 0.19}},
     {.bias = 2.425,
      .ratio = 4.794,
      .left_right = 0.616,
      .variance = 0.362,
      .local = 0.0389,
      .candidates = 0.463,
      .right = {0.064, 0.133, 0.288, 0.484, 0.641, 0.839, 0.942, 0.977, 0.989, 0.994, 0.996, 0.997},
      .sigma_px = {0.84, 0.82, 0.75, 0.71, 0.68, 0.63, 0.48, 0.35, 0.26, 0.21, 0.18, 0.17}},
     {.bias = 2.595,
      .ratio = 4.762,
      .left_right = 0.617,
      .variance = 0.389,
      .local = 0.0464,
      .candidates = 0.403,
      .right = {0.080, 0.179, 0.300, 0.436, 0.660, 0.851, 0.947, 0.979, 0.988, 0.992, 0.993, 0.995},
      .sigma_px = {0.86, 0.77, 0.77, 0.77, 0.73, 0.62, 0.47, 0.33, 0.23, 0.18, 0.18, 0.17}},
     {.bias = 2.519,
      .ratio = 4.877,
      .left_right = 0.622,
      .variance = 0.374,
      .local = 0.0457,
      .candidates = 0.411,
      .right = {0.077, 0.170, 0.300, 0.447, 0.669, 0.852, 0.948, 0.979, 0.988, 0.992, 0.993, 0.995},
      .sigma_px = {0.86, 0.78, 0.76, 0.75, 0.73, 0.62, 0.47, 0.33, 0.23, 0.19, 0.18, 0.17}}}};

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
  const CensusPair padded = pad_for_census(pair);
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
