// All parameters of odometry.
#pragma once

#include "stereovox/core/parameters.h"
#include "stereovox/odometry/direct_alignment.h"
#include "stereovox/odometry/features.h"
#include "stereovox/odometry/initial_motion.h"
#include "stereovox/odometry/keyframe.h"
#include "stereovox/odometry/motion_estimate.h"

namespace stereovox {

struct QualityParams {
  int min_consistent = 10;
  double min_consistent_share = 0.1;
  int min_recognised = 20;
  int min_inliers = 12;
  int plenty_inliers = 40;
  double min_inlier_share = 0.2;
  double max_rms_px = 1.0;
  double max_sigma_m = 0.1;
  double max_sigma_deg = 1.0;
  double max_speed_m_per_s = 60.0;
  double max_turn_deg_per_s = 400.0;
  double max_surprise = 0.03;
  double max_surprise_deg = 4.0;

  void describe(ParameterList& list) {
    list("min_consistent", min_consistent, {3, 1000}, "matches that agree on one rigid motion");
    list("min_consistent_share", min_consistent_share, {0.0, 1.0}, "their share of all matches");
    list("min_recognised", min_recognised, {3, 1000},
         "the same when finding back to an earlier keyframe");
    list("min_inliers", min_inliers, {3, 1000}, "points seen where the refined motion puts them");
    list("plenty_inliers", plenty_inliers, {3, 1000},
         "with fewer, halved images may know the place better and are asked as well");
    list("min_inlier_share", min_inlier_share, {0.0, 1.0},
         "their share of the points that should be visible");
    list("max_rms_px", max_rms_px, {0.01, 100.0}, "largest rms reprojection error");
    list("max_sigma_m", max_sigma_m, {1e-4, 100.0}, "largest standard deviation of the position");
    list("max_sigma_deg", max_sigma_deg, {1e-3, 180.0},
         "largest standard deviation of the direction");
    list("max_speed_m_per_s", max_speed_m_per_s, {0.01, 1000.0}, "faster motion is not believed");
    list("max_turn_deg_per_s", max_turn_deg_per_s, {1.0, 1e5}, "faster turning is not believed");
    list("max_surprise", max_surprise, {0.001, 10.0},
         "farther from where steady motion leads than this share of the median distance of what is "
         "seen, other motions are tried and all pixels asked which one it was");
    list("max_surprise_deg", max_surprise_deg, {0.01, 180.0}, "... or turned by more");
  }
};

struct KeyframeParams {
  double min_consistent_share = 0.25;
  double max_shift = 0.2;
  double max_turn_deg = 15.0;
  int local_count = 2;
  double memory_mb = 256.0;
  int attempts_per_frame = 3;
  int coarser_levels = 2;

  void describe(ParameterList& list) {
    list("min_consistent_share", min_consistent_share, {0.0, 1.0},
         "a new keyframe is made when fewer of the last one's points match");
    list("max_shift", max_shift, {0.001, 10.0},
         "... when the camera has moved by more than this share of their median distance");
    list("max_turn_deg", max_turn_deg, {1.0, 180.0}, "... or has turned by more");
    list("local_count", local_count, {1, 50}, "latest keyframes that together give the place");
    list("memory_mb", memory_mb, {1.0, 1e6},
         "of the keyframes; when they need more, every second of the older ones forgets its view");
    list("attempts_per_frame", attempts_per_frame, {0, 1000},
         "earlier keyframes that a lost frame is compared with");
    list("coarser_levels", coarser_levels, {0, 6},
         "how often images are halved where the finer ones do not give the place");
  }
};

struct PlaceParams {
  int attempts = 3;
  int recent = 10;
  double max_shift = 0.8;
  double max_turn_deg = 40.0;
  double max_miss_m = 0.1;
  double max_drift_share = 0.02;
  double max_miss_deg = 2.0;
  double max_drift_deg_per_m = 0.1;
  double robust_sigmas = 4.0;

  void describe(ParameterList& list) {
    list("attempts", attempts, {0, 1000},
         "of the keyframes just passed, and of all earlier ones, a new one is compared with these");
    list("recent", recent, {1, 1000}, "keyframes that count as just passed");
    list("max_shift", max_shift, {0.01, 100.0},
         "not compared if farther away than this share of the median distance of what it shows");
    list("max_turn_deg", max_turn_deg, {1.0, 180.0}, "... or turned by more");
    list("max_miss_m", max_miss_m, {0.0, 100.0},
         "a place is not believed to be the same if tracking would be wrong by more than this");
    list("max_drift_share", max_drift_share, {0.0, 1.0}, "... and this share of the way between");
    list("max_miss_deg", max_miss_deg, {0.0, 180.0}, "the same for the direction");
    list("max_drift_deg_per_m", max_drift_deg_per_m, {0.0, 180.0},
         "... and this for each metre of the way between");
    list("robust_sigmas", robust_sigmas, {0.5, 1000.0},
         "measured motions that miss by more standard deviations count little");
  }
};

struct OdometryParams {
  FeatureParams features;
  MatchingParams matching;
  AlignmentParams alignment;
  DirectParams direct;
  RefinementParams refinement;
  QualityParams quality;
  KeyframeParams keyframes;
  PlaceParams places;

  void describe(ParameterList& list) {
    list.section("features", features);
    list.section("matching", matching);
    list.section("alignment", alignment);
    list.section("direct", direct);
    list.section("refinement", refinement);
    list.section("quality", quality);
    list.section("keyframes", keyframes);
    list.section("places", places);
  }
};

}  // namespace stereovox
