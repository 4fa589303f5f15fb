// What OpenCV's two matchers have in common: where they search and what they reject. The parameters
// carry the names of ROS' stereo_image_proc.
#pragma once

#include "stereovox/core/parameters.h"

namespace stereovox {

struct DisparitySearch {
  int min_disparity_px = 0;
  int disparity_range_px = 64;
  int prefilter_cap = 31;
  int uniqueness_ratio_percent = 10;
  int left_right_tolerance_px = 1;
  int speckle_size_px = 100;
  int speckle_range_px = 2;
  double sigma_px = 0.2, sigma_noise_gray = 0.4;  // see texture_sigma.h

  // OpenCV wants a multiple of 16, and counts sixteenths of a pixel in 16 bits: the ranges below
  // keep the largest disparity under 2048.
  int range_px() const { return (disparity_range_px + 15) / 16 * 16; }
  int max_disparity_px() const { return min_disparity_px + range_px(); }

  void describe(ParameterList& list) {
    list("min_disparity_px", min_disparity_px, {0, 512}, "smallest disparity that is searched");
    list("disparity_range_px", disparity_range_px, {16, 1024},
         "number of disparities that are searched, rounded up to a multiple of 16");
    list("prefilter_cap", prefilter_cap, {1, 63}, "image derivatives are clipped to this");
    list("uniqueness_ratio_percent", uniqueness_ratio_percent, {0, 100},
         "the best cost must undercut the second best by this much");
    list("left_right_tolerance_px", left_right_tolerance_px, {0, 64},
         "left and right disparities may differ by this much");
    list("speckle_size_px", speckle_size_px, {0, 100000}, "smaller islands are removed");
    list("speckle_range_px", speckle_range_px, {1, 64}, "largest disparity step inside an island");
    list("sigma_px", sigma_px, {0.01, 10}, "standard deviation of a disparity on rich texture");
    list("sigma_noise_gray", sigma_noise_gray, {0, 100},
         "what adds to it on weak texture, divided by the brightness gradient; 0 = nothing");
  }
};

}  // namespace stereovox
