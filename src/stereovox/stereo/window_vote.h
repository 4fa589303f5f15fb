// Pixels without a match of their own take the disparity that most of their window agrees on: after
// the local high-confidence voting of Zhang, Lu and Lafruit (CSVT 2009).
#pragma once

#include <opencv2/core/mat.hpp>

#include "stereovox/stereo/match_confidence.h"
#include "stereovox/stereo/window_sweep.h"

namespace stereovox {

// What a pixel must show to vote; all others are voted about.
struct VoterParams {
  int min_log_ratio = 0;   // see MatchFeatures
  int max_left_right = 0;  // in steps
  double min_share = 0.5;  // of the pixels of a window that must agree
};

// Votes are counted by whole pixels of disparity. A pixel that is voted about gets the mean
// disparity, cost and left-right difference of the voters that won, and their log ratio weighed by
// their share of the window; where they are too few it keeps what it has. Pixels where `recorded`
// (empty: all are) is 0 do not vote.
void vote_in_windows(MatchFeatures& features, const Arms& arms, const cv::Mat1b& recorded,
                     const VoterParams& params, int threads);

}  // namespace stereovox
