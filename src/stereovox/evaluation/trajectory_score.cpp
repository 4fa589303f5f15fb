#include "stereovox/evaluation/trajectory_score.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "stereovox/core/error.h"
#include "stereovox/evaluation/relative_pose_error.h"

namespace stereovox {
namespace {

constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;
constexpr int kSegmentLengths = 8;  // KITTI's 100, 200 .. 800 m
constexpr double kKittiSegmentStep_m = 100.0;
constexpr double kShortestKittiPath_m = 2.0 * kKittiSegmentStep_m;

using Points = Eigen::Matrix3Xd;

Points positions_of(std::span<const SE3> poses) {
  Points points(3, static_cast<Eigen::Index>(poses.size()));
  for (std::size_t i = 0; i < poses.size(); ++i)
    points.col(static_cast<Eigen::Index>(i)) = poses[i].translation;
  return points;
}

bool is_standing(const Points& points) {
  return (points.colwise() - points.col(0)).cwiseAbs().maxCoeff() == 0.0;
}

// The similarity that takes the estimate's world to the truth's.
Eigen::Matrix4d alignment_matrix(const PosePairs& pairs, Alignment alignment) {
  if (alignment == Alignment::none) return Eigen::Matrix4d::Identity();
  if (alignment == Alignment::origin) {
    const SE3 T = pairs.truth.front() * inverse(pairs.estimate.front());
    return (Eigen::Translation3d(T.translation) * T.rotation).matrix();
  }
  const Points estimate = positions_of(pairs.estimate);
  const bool with_scale = alignment == Alignment::sim3;
  if (with_scale && is_standing(estimate))
    throw Error("trajectories: the estimate stands still, so it has no scale to align");
  return Eigen::umeyama(estimate, positions_of(pairs.truth), with_scale);
}

ErrorStatistics absolute_errors(const PosePairs& pairs, const Eigen::Matrix4d& S_truth_estimate) {
  std::vector<double> errors_m;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Eigen::Vector3d aligned =
        (S_truth_estimate * pairs.estimate[i].translation.homogeneous()).head<3>();
    errors_m.push_back((aligned - pairs.truth[i].translation).norm());
  }
  return statistics_of(errors_m);
}

void add_relative_errors(const PosePairs& pairs, const TrajectoryScoreParams& params,
                         TrajectoryScore& score) {
  const auto& reference = params.rpe_pairs_from_truth ? pairs.truth : pairs.estimate;
  const auto index_pairs =
      params.rpe_unit == RpeUnit::frames
          ? pairs_by_frames(reference.size(), params.rpe_delta, params.rpe_all_pairs)
          : pairs_by_path(reference, params.rpe_delta, params.rpe_all_pairs);
  std::vector<double> translation_m, rotation_deg;
  for (const auto& [i, j] : index_pairs) {
    const SE3 error = relative_pose_error(pairs, i, j);
    translation_m.push_back(error.translation.norm());
    rotation_deg.push_back(rotation_angle_rad(error) * kDegreesPerRadian);
  }
  score.rpe_translation_m = statistics_of(translation_m);
  score.rpe_rotation_deg = statistics_of(rotation_deg);
}

// Sums errors per metre; `mean` turns them into a score.
struct SegmentSums {
  int segments = 0;
  double translation = 0, rotation_rad_per_m = 0;

  void add(const SE3& error, double length_m) {
    ++segments;
    translation += error.translation.norm() / length_m;
    rotation_rad_per_m += rotation_angle_rad(error) / length_m;
  }
  void add(const SegmentSums& other) {
    segments += other.segments;
    translation += other.translation;
    rotation_rad_per_m += other.rotation_rad_per_m;
  }
  SegmentScore mean(double length_m) const {
    const double count = std::max(segments, 1);
    return {length_m, segments, 100.0 * translation / count,
            kDegreesPerRadian * rotation_rad_per_m / count};
  }
};

// From every `start_step`-th frame to the first one that is more than `length_m` of way ahead.
SegmentSums sum_segments(const PosePairs& pairs, std::span<const double> way_m, double length_m,
                         int start_step) {
  SegmentSums sums;
  for (std::size_t first = 0; first < pairs.size(); first += static_cast<std::size_t>(start_step)) {
    const auto last = std::ranges::upper_bound(way_m, way_m[first] + length_m);
    if (last == way_m.end()) break;  // and so for all later starts
    const auto last_index = static_cast<std::size_t>(last - way_m.begin());
    sums.add(relative_pose_error(pairs, first, last_index), length_m);
  }
  return sums;
}

void add_segment_errors(const PosePairs& pairs, const TrajectoryScoreParams& params,
                        TrajectoryScore& score) {
  const std::vector<double> way_m = way_along(pairs.truth);
  const std::vector<double> lengths_m = params.segment_lengths_m.empty()
                                            ? segment_lengths_for(way_m.back())
                                            : params.segment_lengths_m;
  SegmentSums all;
  for (const double length_m : lengths_m) {
    const SegmentSums sums = sum_segments(pairs, way_m, length_m, params.segment_start_step);
    score.segments.push_back(sums.mean(length_m));
    all.add(sums);
  }
  score.segments_overall = all.mean(0.0);
}

void add_end_drift(const PosePairs& pairs, TrajectoryScore& score) {
  const SE3 truth = inverse(pairs.truth.front()) * pairs.truth.back();
  const SE3 estimate = inverse(pairs.estimate.front()) * pairs.estimate.back();
  score.path_length_m = way_along(pairs.truth).back();
  score.end_drift_m = (estimate.translation - truth.translation).norm();
  if (score.path_length_m > 0.0)
    score.end_drift_percent = 100.0 * score.end_drift_m / score.path_length_m;
}

void require_finite(std::span<const SE3> poses, const char* which) {
  const auto bad = std::ranges::find_if_not(poses, is_finite);
  if (bad != poses.end())
    throw Error(fmt::format("trajectories: matched pose {} of the {} is not finite",
                            bad - poses.begin(), which));
}

}  // namespace

std::span<const std::string> names_of(Alignment) {
  static const std::vector<std::string> names = {"none", "origin", "se3", "sim3"};
  return names;
}

std::span<const std::string> names_of(RpeUnit) {
  static const std::vector<std::string> names = {"frames", "metres"};
  return names;
}

void TrajectoryScoreParams::describe(ParameterList& list) {
  list("alignment", alignment, "how the estimate is moved onto the truth before the ATE");
  list("max_stamp_difference_s", max_stamp_difference_s, {0, 10},
       "poses farther apart in time do not belong together");
  list("rpe_unit", rpe_unit, "what rpe_delta counts");
  list("rpe_delta", rpe_delta, {0.001, 1e6}, "distance of the poses of a relative error");
  list("rpe_all_pairs", rpe_all_pairs, "relative errors from every pose, not only end to end");
  list("rpe_pairs_from_truth", rpe_pairs_from_truth,
       "metres between poses are counted on the truth, not on the estimate");
  list("segment_start_step", segment_start_step, {1, 1000},
       "a drift segment starts at every so many frames (KITTI: 10)");
}

std::vector<double> segment_lengths_for(double path_length_m) {
  if (!(path_length_m > 0.0)) return {};
  double step_m = kKittiSegmentStep_m;
  if (path_length_m < kShortestKittiPath_m) {
    const double longest_step_m = path_length_m / kSegmentLengths;
    const double decade_m = std::pow(10.0, std::floor(std::log10(longest_step_m)));
    step_m = decade_m;
    for (const double multiple : {2.0, 5.0})
      if (multiple * decade_m <= longest_step_m) step_m = multiple * decade_m;
  }
  std::vector<double> lengths_m;
  for (int i = 1; i <= kSegmentLengths; ++i) lengths_m.push_back(i * step_m);
  return lengths_m;
}

TrajectoryScore score_pose_pairs(const PosePairs& pairs, const TrajectoryScoreParams& params) {
  if (pairs.truth.empty()) throw Error("trajectories: no pose pairs to score");
  require_finite(pairs.truth, "truth");
  require_finite(pairs.estimate, "estimate");
  const Eigen::Matrix4d S_truth_estimate = alignment_matrix(pairs, params.alignment);

  TrajectoryScore score;
  score.alignment = params.alignment;
  score.scale = params.alignment == Alignment::sim3
                    ? std::cbrt(S_truth_estimate.topLeftCorner<3, 3>().determinant())
                    : 1.0;
  score.ate_m = absolute_errors(pairs, S_truth_estimate);
  add_relative_errors(pairs, params, score);
  add_segment_errors(pairs, params, score);
  add_end_drift(pairs, score);
  score.matched = static_cast<int>(pairs.size());
  score.unmatched_truth = pairs.unmatched_truth;
  score.unmatched_estimate = pairs.unmatched_estimate;
  return score;
}

TrajectoryScore score_trajectory(const Trajectory& truth, const Trajectory& estimate,
                                 const TrajectoryScoreParams& params) {
  return score_pose_pairs(match_by_stamp(truth, estimate, params.max_stamp_difference_s), params);
}

}  // namespace stereovox
