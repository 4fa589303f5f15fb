// The most likely places of a camera from measured motions between them (Lu, Milios 1997; in the
// sparse form of Kuemmerle et al. 2011, "g2o").
#pragma once

#include <span>
#include <vector>

#include "stereovox/core/se3.h"

namespace stereovox {

// The motion from pose `from` to pose `to`, as measured. `information` is the inverse covariance of
// the twist x in T_true = T_from_to * exp(x).
struct PoseLink {
  int from = 0, to = 0;
  SE3 T_from_to = {};
  Matrix6d information = Matrix6d::Identity();
};

// Of each link, log(T_from_to^-1 * inverse(pose[from]) * pose[to]) weighted: the squared number of
// standard deviations by which the poses miss the measured motion.
double chi_squared(const PoseLink& link, std::span<const SE3> poses);

// Moves all poses but those that are fixed to where the links fit best, starting from what `poses`
// holds. A link that is missed by far more than `robust_sigmas` standard deviations counts little
// (Cauchy). Poses that no chain of links ties to a fixed one keep their place.
void optimize(std::span<const PoseLink> links, const std::vector<bool>& is_fixed,
              double robust_sigmas, std::vector<SE3>& poses);

}  // namespace stereovox
