// Local matching on a census cost: each pixel is compared over a window that does not reach across
// the edges of things. It follows the brightness about the pixel (`cross`: Zhang, Lu and Lafruit,
// "Cross-based local stereo matching using orthogonal integral images", CSVT 2009), or consists of
// those squares near the pixel that match best (multiple_windows.h). window_sweep.h and
// multiple_windows.h do the work.
#pragma once

#include <span>
#include <string>

#include "stereovox/core/frame.h"
#include "stereovox/core/image.h"
#include "stereovox/stereo/census_search.h"
#include "stereovox/stereo/match_confidence.h"
#include "stereovox/stereo/window_kernels.h"

namespace stereovox {

enum class WindowSupport { cross, one_window, five_windows, nine_windows };
std::span<const std::string> names_of(WindowSupport);

struct AdaptiveWindowParams {
  static constexpr const char* kName = "adaptive_window";

  CensusSearch search;
  WindowSupport support = WindowSupport::cross;
  int window_half_px = 3;
  int max_arm_px = 17;
  int arm_contrast_gray = 10;
  double min_vote_share = 0.5;

  void describe(ParameterList& list) {
    search.describe(list);
    list("support", support,
         "a cross that follows the brightness, or a square with the better half of none, four or "
         "eight neighbours");
    list("window_half_px", window_half_px, {1, kMaxWindowHalf_px},
         "a square has twice this and one rows and columns");
    list("max_arm_px", max_arm_px, {1, kMaxArm_px},
         "how far a cross may reach from its pixel in each direction");
    list("arm_contrast_gray", arm_contrast_gray, {0, 255},
         "a cross ends where the brightness differs by more than this");
    list("min_vote_share", min_vote_share, {0, 1},
         "a pixel without a match takes the disparity of this share of its cross; 1 = never");
  }
};

// Contract: see matcher.h.
DisparityImage match(const RectifiedPair& pair, const AdaptiveWindowParams& params, int threads);

// What the disparities and their confidence are made of, before anything is rejected.
MatchFeatures match_features(const RectifiedPair& pair, const AdaptiveWindowParams& params,
                             int threads);

}  // namespace stereovox
