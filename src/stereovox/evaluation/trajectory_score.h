// How right a trajectory is. Three customs, each as its own tool does it, so that figures compare:
//   ATE  evo_ape: distance of matched positions after alignment;
//   RPE  evo_rpe: error of the motion between pose pairs a fixed number of frames or metres apart;
//   KITTI odometry development kit: drift over segments of fixed length, per metre.
//
//   const TrajectoryScore score = score_trajectory(truth, estimate, {});
//   score.ate_m.rmse; score.segments_overall.t_rel_percent;
#pragma once

#include <vector>

#include "stereovox/core/parameters.h"
#include "stereovox/core/trajectory.h"
#include "stereovox/evaluation/error_statistics.h"
#include "stereovox/evaluation/pose_pairs.h"

namespace stereovox {

enum class Alignment {
  none,    // both are in one world already
  origin,  // the first poses coincide
  se3,     // best rotation and translation (Umeyama 1991)
  sim3,    // also the best scale; not for stereo, which knows its scale
};
std::span<const std::string> names_of(Alignment);

enum class RpeUnit { frames, metres };
std::span<const std::string> names_of(RpeUnit);

struct TrajectoryScoreParams {
  Alignment alignment = Alignment::se3;
  double max_stamp_difference_s = 0.01;
  RpeUnit rpe_unit = RpeUnit::frames;
  double rpe_delta = 1.0;             // in rpe_unit; frames are rounded
  bool rpe_all_pairs = false;         // every start, not only where the last pair ended
  bool rpe_pairs_from_truth = false;  // metres are counted on the truth, not on the estimate
  int segment_start_step = 10;
  // Empty: segment_lengths_for(way). A list, so not among the described parameters.
  std::vector<double> segment_lengths_m = {};

  void describe(ParameterList& list);
};

// KITTI's 100, 200 .. 800 m for a way of at least 200 m; else eight lengths with the largest step
// of 1, 2 or 5 times a power of ten that lets the longest fit (60 m: 5, 10 .. 40 m). Empty for no
// way.
std::vector<double> segment_lengths_for(double path_length_m);

// Mean errors over segments of one length, per length, as in the KITTI kit.
struct SegmentScore {
  double length_m = 0;  // 0 in the mean over all lengths
  int segments = 0;     // 0: the way is too short for this length, the errors mean nothing
  double t_rel_percent = 0, r_rel_deg_per_m = 0;
};

struct TrajectoryScore {
  Alignment alignment = Alignment::se3;
  double scale = 1.0;  // that aligns the estimate; 1 but for sim3
  ErrorStatistics ate_m;
  ErrorStatistics rpe_translation_m, rpe_rotation_deg;  // count 0: no two poses are so far apart
  std::vector<SegmentScore> segments;
  SegmentScore segments_overall;
  double path_length_m = 0;      // of the truth, over the matched poses
  double end_drift_m = 0;        // distance of the last positions when the first poses coincide
  double end_drift_percent = 0;  // of the way; 0 when there is none
  int matched = 0, unmatched_truth = 0, unmatched_estimate = 0;
};

// Throws Error when no time stamps match, a pose is not finite, or scale is asked of a standing
// estimate.
TrajectoryScore score_trajectory(const Trajectory& truth, const Trajectory& estimate,
                                 const TrajectoryScoreParams& params);

// The same for poses that are matched already, for instance by index.
TrajectoryScore score_pose_pairs(const PosePairs& pairs, const TrajectoryScoreParams& params);

}  // namespace stereovox
