// Semi-global matching on a census cost, which an offset of brightness does not change, with a
// probability and a standard deviation for every disparity. census_sweep.h does the work.
#pragma once

#include "stereovox/core/frame.h"
#include "stereovox/core/image.h"
#include "stereovox/stereo/census_search.h"
#include "stereovox/stereo/match_confidence.h"

namespace stereovox {

struct CensusSgmParams {
  static constexpr const char* kName = "census_sgm";

  CensusSearch search;
  int smoothness_small = 18;
  int smoothness_nearer = 12;
  int smoothness_large = 200;
  double edge_contrast_gray = 3.0;

  void describe(ParameterList& list) {
    search.describe(list);
    list("smoothness_small", smoothness_small, {0, 100},
         "penalty for a disparity step of one pixel (P1), in census bits");
    list("smoothness_nearer", smoothness_nearer, {0, 100},
         "the same where a surface comes nearer down the image, as floors do; at most "
         "smoothness_small");
    list("smoothness_large", smoothness_large, {1, 220},
         "penalty for a larger disparity step where the brightness is even (P2)");
    list("edge_contrast_gray", edge_contrast_gray, {1, 10000},
         "brightness step at which the penalty for a larger disparity step is halved");
  }
};

// Contract: see matcher.h.
DisparityImage match(const RectifiedPair& pair, const CensusSgmParams& params, int threads);

// What the disparities and their confidence are made of, before anything is rejected.
MatchFeatures match_features(const RectifiedPair& pair, const CensusSgmParams& params, int threads);

}  // namespace stereovox
