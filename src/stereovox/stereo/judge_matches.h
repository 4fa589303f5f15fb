// From the winners of a census matcher to disparities: sub-pixel positions, the features of their
// confidence, and what is rejected.
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "stereovox/core/frame.h"
#include "stereovox/core/image.h"
#include "stereovox/stereo/census_search.h"
#include "stereovox/stereo/census_sweep.h"
#include "stereovox/stereo/match_confidence.h"

namespace stereovox {

MatchFeatures features_of_size(cv::Size size);

// Writes row v of all features but the variance. The sub-pixel position is the vertex of the
// parabola through the local costs of the winner and its neighbours.
void fill_feature_row(const WinnerRow& winners, int max_disparity_px, int v,
                      MatchFeatures& features);

// Disparities that pass the checks of `search`, join two recorded pixels and are > 0, with the
// confidence and sigma of `model`.
DisparityImage judge_matches(const RectifiedPair& pair, const MatchFeatures& features,
                             const CensusSearch& search, const ConfidenceModel& model, int threads);

}  // namespace stereovox
