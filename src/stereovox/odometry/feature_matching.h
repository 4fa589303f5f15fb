// Which corners of two images are the same, judged by their looks alone
// (Hirschmueller, Innocent, Garibaldi 2002; vision.md 1.7, step 3).
#pragma once

#include <span>
#include <vector>

#include "stereovox/odometry/features.h"

namespace stereovox {

struct FeatureMatch {
  int reference, current;  // indices into the two sets
  double score;            // correlation
};

// Pairs that are each other's best match: the current feature within `half_window_px` (in both
// directions) of where the reference feature is expected, with a correlation of `min_score` or
// more. `expected_px` holds one pixel of the current image for each reference feature. In the order
// of the reference features.
std::vector<FeatureMatch> match_features(const FeatureSet& reference,
                                         std::span<const Eigen::Vector2d> expected_px,
                                         const FeatureSet& current, double half_window_px,
                                         double min_score);

}  // namespace stereovox
