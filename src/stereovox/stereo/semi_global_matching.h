// Semi-global matching by OpenCV's StereoSGBM in its three-path mode, which of OpenCV's modes is
// both the fastest and the most accurate.
#pragma once

#include "stereovox/core/frame.h"
#include "stereovox/core/image.h"
#include "stereovox/core/parameters.h"

namespace stereovox {

struct SemiGlobalMatchingParams {
  static constexpr const char* kName = "sgbm";

  int min_disparity_px = 0;
  int disparity_range_px = 64;
  int block_size_px = 3;
  int smoothness_small = 72;
  int smoothness_large = 288;
  int prefilter_cap = 31;
  int uniqueness_ratio_percent = 10;
  int left_right_tolerance_px = 1;
  int speckle_size_px = 100;
  int speckle_range_px = 2;
  double sigma_px = 0.25;

  void describe(ParameterList& list) {
    list("min_disparity_px", min_disparity_px, {0, 1024}, "smallest disparity that is searched");
    list("disparity_range_px", disparity_range_px, {16, 1024},
         "number of disparities that are searched, rounded up to a multiple of 16");
    list("block_size_px", block_size_px, {1, 21}, "side of the matched block; even becomes odd");
    list("smoothness_small", smoothness_small, {0, 10000},
         "penalty for a disparity step of one pixel (P1)");
    list("smoothness_large", smoothness_large, {1, 40000},
         "penalty for a larger disparity step (P2); must exceed smoothness_small");
    list("prefilter_cap", prefilter_cap, {1, 63}, "image derivatives are clipped to this");
    list("uniqueness_ratio_percent", uniqueness_ratio_percent, {0, 100},
         "the best cost must undercut the second best by this much");
    list("left_right_tolerance_px", left_right_tolerance_px, {0, 64},
         "left and right disparities may differ by this much");
    list("speckle_size_px", speckle_size_px, {0, 100000}, "smaller islands are removed");
    list("speckle_range_px", speckle_range_px, {1, 64}, "largest disparity step inside an island");
    list("sigma_px", sigma_px, {0.01, 10}, "standard deviation given to every disparity");
  }
};

// Contract: see matcher.h.
DisparityImage match(const RectifiedPair& pair, const SemiGlobalMatchingParams& params);

}  // namespace stereovox
