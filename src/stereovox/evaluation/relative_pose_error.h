// The error of the motion between two matched poses, and which poses to take (evo's conventions).
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "stereovox/evaluation/pose_pairs.h"

namespace stereovox {

using IndexPair = std::pair<std::size_t, std::size_t>;

// E = (Q_i^-1 Q_j)^-1 (P_i^-1 P_j), Q the truth, P the estimate: identity when the motions agree.
// It does not change when either world is moved.
SE3 relative_pose_error(const PosePairs& pairs, std::size_t i, std::size_t j);

// Length of the way to each pose, from the first; {0} for no poses.
std::vector<double> way_along(std::span<const SE3> poses);

// (i, i + delta) for i = 0, delta, 2 delta .. or, for all pairs, for every i. delta is rounded,
// >= 1.
std::vector<IndexPair> pairs_by_frames(std::size_t count, double delta, bool all_pairs);

// Poses `delta_m` of way apart. Consecutive: each pair starts where the one before it ended, the
// first where the way first reaches delta_m. All pairs: from every pose to that whose way ahead is
// nearest to delta_m, if it is within a tenth of it.
std::vector<IndexPair> pairs_by_path(std::span<const SE3> poses, double delta_m, bool all_pairs);

}  // namespace stereovox
