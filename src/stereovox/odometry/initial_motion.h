// A first estimate of the motion between two frames from their corners alone, with or without
// knowing where to expect them (Hirschmueller, Innocent, Garibaldi 2002; vision.md 1.7 and 4.4).
#pragma once

#include <optional>

#include "stereovox/core/se3.h"
#include "stereovox/odometry/feature_matching.h"
#include "stereovox/odometry/motion_estimate.h"

namespace stereovox {

struct MatchingParams {
  double min_correlation = 0.7;
  double predicted_window = 0.04;
  double narrow_window = 0.2;
  double wide_window = 0.6;
  int enough_consistent = 30;
  double enough_consistent_share = 0.5;
  double max_sigmas = 3.0;

  void describe(ParameterList& list) {
    list("min_correlation", min_correlation, {0.0, 1.0}, "least correlation of matching corners");
    list("predicted_window", predicted_window, {0.001, 1.0},
         "matches are sought this share of the image width around where steady motion takes them");
    list("narrow_window", narrow_window, {0.001, 1.0},
         "the same without prediction, first of two tries of which the more consistent counts");
    list("wide_window", wide_window, {0.001, 2.0}, "the same, second try");
    list("enough_consistent", enough_consistent, {3, 1000},
         "with fewer consistent matches near the predicted places the other tries are made too");
    list("enough_consistent_share", enough_consistent_share, {0.0, 1.0},
         "the same with a smaller share of all matches: a repeated pattern may mislead");
    list("max_sigmas", max_sigmas, {0.5, 10.0},
         "standard deviations by which distances may change between consistent points");
  }
};

struct InitialMotion {
  int matches = 0;                            // corners that look alike
  std::vector<FeatureMatch> consistent = {};  // those that agree on one rigid motion
  SE3 T_reference_current = {};               // meaningful when at least 3 are consistent

  int consistent_count() const { return static_cast<int>(consistent.size()); }
};

// From corners near the places that `T_reference_predicted` gives alone.
InitialMotion find_motion_near(const RectifiedCamera& camera, const FeatureSet& reference,
                               const FeatureSet& current, const SE3& T_reference_predicted,
                               const MatchingParams& params, const RefinementParams& refinement);

// Tries the small window around the places that `T_reference_predicted` gives; when there is no
// prediction or too few matches are consistent, both windows around the unmoved places. The try
// with most consistent matches counts.
InitialMotion find_initial_motion(const RectifiedCamera& camera, const FeatureSet& reference,
                                  const FeatureSet& current,
                                  const std::optional<SE3>& T_reference_predicted,
                                  const MatchingParams& params, const RefinementParams& refinement);

}  // namespace stereovox
