// What the matchers on the census cost have in common: where they search and what they reject.
#pragma once

#include "stereovox/core/parameters.h"
#include "stereovox/stereo/census_kernels.h"

namespace stereovox {

struct CensusSearch {
  int min_disparity_px = 0;
  int disparity_range_px = 64;
  int uniqueness_ratio_percent = 2;
  int left_right_tolerance_px = 3;
  int speckle_size_px = 100;
  int speckle_range_px = 2;
  double min_confidence = 0.62;
  double island_confidence = 0.96;
  int edge_likeness_gray = 48;

  int candidates() const {
    return (disparity_range_px + kCandidateStep - 1) / kCandidateStep * kCandidateStep;
  }
  int max_disparity_px() const { return min_disparity_px + candidates() - 1; }

  void describe(ParameterList& list) {
    list("min_disparity_px", min_disparity_px, {-512, 512},
         "smallest disparity that is searched; those up to 0 are found, but mean no distance");
    list("disparity_range_px", disparity_range_px, {1, kMaxCandidates},
         "number of disparities that are searched, rounded up to a multiple of 32");
    list("uniqueness_ratio_percent", uniqueness_ratio_percent, {0, 99},
         "the best cost must undercut the second best by this much");
    list("left_right_tolerance_px", left_right_tolerance_px, {0, 64},
         "left and right disparities may differ by this much");
    list("speckle_size_px", speckle_size_px, {0, 100000},
         "islands of fewer pixels with island_confidence are removed");
    list("speckle_range_px", speckle_range_px, {1, 64}, "largest disparity step inside an island");
    list("min_confidence", min_confidence, {0, 1},
         "disparities that are less probably within 2 px are removed");
    list("island_confidence", island_confidence, {0, 1},
         "what the pixels of an island are counted by: noise gives islands, but no sure ones");
    list(
        "edge_likeness_gray", edge_likeness_gray, {0, 255},
        "at edges disparities are medians of neighbours that differ by less in brightness; 0: not");
  }
};

}  // namespace stereovox
