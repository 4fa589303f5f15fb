// Which pose of an estimated trajectory belongs to which pose of the true one.
#pragma once

#include <span>
#include <vector>

#include "stereovox/core/trajectory.h"

namespace stereovox {

// Poses at the same times: truth[i] belongs to estimate[i]. Both have the same size.
struct PosePairs {
  std::vector<SE3> truth, estimate;  // T_world_camera, each in its own world
  int unmatched_truth = 0, unmatched_estimate = 0;

  std::size_t size() const { return truth.size(); }
};

// Each pose of the trajectory with fewer poses (equal: the estimate) is matched to the nearest in
// time of the other one, if it is within the difference (evo's association); a pose claimed twice
// stays with the nearer claim. Throws Error when nothing matches.
PosePairs match_by_stamp(const Trajectory& truth, const Trajectory& estimate,
                         double max_stamp_difference_s);

// For files without time stamps (KITTI): the i-th belongs to the i-th. Throws Error when the counts
// differ or are 0.
PosePairs match_by_index(std::span<const SE3> truth, std::span<const SE3> estimate);

}  // namespace stereovox
