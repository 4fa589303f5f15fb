// Local block matching by OpenCV's StereoBM: fast, sparse, fattened at edges.
#pragma once

#include "stereovox/core/frame.h"
#include "stereovox/core/image.h"
#include "stereovox/stereo/disparity_search.h"

namespace stereovox {

struct BlockMatchingParams {
  static constexpr const char* kName = "bm";

  DisparitySearch search{.sigma_px = 0.5};
  int correlation_window_size_px = 15;
  int texture_threshold = 10;

  void describe(ParameterList& list) {
    search.describe(list);
    list("correlation_window_size_px", correlation_window_size_px, {5, 63},
         "side of the matched block; even becomes odd");
    list("texture_threshold", texture_threshold, {0, 100000},
         "blocks with a smaller sum of derivatives have no disparity");
  }
};

// Contract: see matcher.h.
DisparityImage match(const RectifiedPair& pair, const BlockMatchingParams& params, int threads = 1);

}  // namespace stereovox
