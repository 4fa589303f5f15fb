// Local matching on a census cost: each pixel is compared over a window that follows the brightness
// around it, so that it does not reach across the edges of things. After Zhang, Lu and Lafruit
// ("Cross-based local stereo matching using orthogonal integral images", CSVT 2009).
// window_sweep.h does the work.
#pragma once

#include "stereovox/core/frame.h"
#include "stereovox/core/image.h"
#include "stereovox/stereo/census_search.h"
#include "stereovox/stereo/match_confidence.h"
#include "stereovox/stereo/window_kernels.h"

namespace stereovox {

struct AdaptiveWindowParams {
  static constexpr const char* kName = "adaptive_window";

  CensusSearch search;
  int max_arm_px = 17;
  int arm_contrast_gray = 10;
  double min_vote_share = 0.5;

  void describe(ParameterList& list) {
    search.describe(list);
    list("max_arm_px", max_arm_px, {1, kMaxArm_px},
         "how far a window may reach from its pixel in each direction");
    list("arm_contrast_gray", arm_contrast_gray, {0, 255},
         "a window ends where the brightness differs by more than this");
    list("min_vote_share", min_vote_share, {0, 1},
         "a pixel without a match takes the disparity of this share of its window; 1 = never");
  }
};

// Contract: see matcher.h.
DisparityImage match(const RectifiedPair& pair, const AdaptiveWindowParams& params, int threads);

// What the disparities and their confidence are made of, before anything is rejected.
MatchFeatures match_features(const RectifiedPair& pair, const AdaptiveWindowParams& params,
                             int threads);

}  // namespace stereovox
