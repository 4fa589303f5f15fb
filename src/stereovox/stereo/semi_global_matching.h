// Semi-global matching by OpenCV's StereoSGBM in its three-path mode, which of OpenCV's modes is
// both the fastest and the most accurate.
#pragma once

#include "stereovox/core/frame.h"
#include "stereovox/core/image.h"
#include "stereovox/stereo/disparity_search.h"

namespace stereovox {

struct SemiGlobalMatchingParams {
  static constexpr const char* kName = "sgbm";

  DisparitySearch search;
  int block_size_px = 3;
  int smoothness_small = 72;
  int smoothness_large = 288;

  void describe(ParameterList& list) {
    search.describe(list);
    list("block_size_px", block_size_px, {1, 21}, "side of the matched block; even becomes odd");
    list("smoothness_small", smoothness_small, {0, 10000},
         "penalty for a disparity step of one pixel (P1)");
    list("smoothness_large", smoothness_large, {1, 40000},
         "penalty for a larger disparity step (P2); must exceed smoothness_small");
  }
};

// Contract: see matcher.h.
DisparityImage match(const RectifiedPair& pair, const SemiGlobalMatchingParams& params,
                     int threads = 1);

}  // namespace stereovox
