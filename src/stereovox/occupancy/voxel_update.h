// Eq. (14): how one observation changes one voxel.
#pragma once

#include <cstdint>
#include <limits>

#include "stereovox/core/timestamp.h"
#include "stereovox/occupancy/credibility_input.h"
#include "stereovox/occupancy/voxel_map.h"

namespace stereovox {

// Seconds since the voxel was last seen; 0 when the frame is older than that.
inline double age_s(const Voxel& voxel, std::uint32_t stamp_ms) {
  constexpr double kSecondsPerMillisecond = 1e-3;
  return stamp_ms > voxel.last_seen_ms ? (stamp_ms - voxel.last_seen_ms) * kSecondsPerMillisecond
                                       : 0.0;
}

// The new state; count and time of the voxel follow.
inline void update_voxel(float observation, double credibility, double initial_state,
                         std::uint32_t stamp_ms, Voxel& voxel) {
  const double state = is_known(voxel) ? static_cast<double>(voxel.state) : initial_state;
  voxel.state = static_cast<float>((1.0 - credibility) * state + credibility * observation);
  if (voxel.observations < std::numeric_limits<std::uint16_t>::max()) ++voxel.observations;
  if (voxel.observations == 1 || stamp_ms > voxel.last_seen_ms) voxel.last_seen_ms = stamp_ms;
}

}  // namespace stereovox
