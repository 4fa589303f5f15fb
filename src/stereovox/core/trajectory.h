// A sequence of camera poses in time.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "stereovox/core/se3.h"

namespace stereovox {

struct StampedPose {
  std::int64_t stamp_ns = 0;
  SE3 T_world_camera;
};

// Ordered by strictly increasing time stamps.
using Trajectory = std::vector<StampedPose>;

// The pose at a time: the entry within `tolerance_ns` of it, else interpolated between two
// neighbours that are at most `max_gap_ns` apart, else nothing.
std::optional<SE3> pose_at(const Trajectory& trajectory, std::int64_t stamp_ns,
                           std::int64_t tolerance_ns, std::int64_t max_gap_ns);

// Length of the way, in metres.
double path_length_m(const Trajectory& trajectory);

}  // namespace stereovox
