// How one observation changes one voxel.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

#include "stereovox/core/timestamp.h"
#include "stereovox/occupancy/update_rules.h"
#include "stereovox/occupancy/voxel_map.h"

namespace stereovox {

// Seconds since the voxel was last seen; 0 when the frame is older than that.
inline double age_s(std::uint32_t last_seen_ms, std::uint32_t stamp_ms) {
  constexpr double kSecondsPerMillisecond = 1e-3;
  return stamp_ms > last_seen_ms ? (stamp_ms - last_seen_ms) * kSecondsPerMillisecond : 0.0;
}

inline VoxelBelief belief_of(const Voxel& voxel) {
  if (!is_known(voxel)) return kNoBelief;
  return {.state = static_cast<double>(voxel.state),
          .ignorance = voxel.ignorance / kIgnoranceSteps};
}

// The voxel believes this now; count and time follow.
inline void store(const VoxelBelief& belief, std::uint32_t stamp_ms, Voxel& voxel) {
  voxel.state = static_cast<float>(belief.state);
  voxel.ignorance = static_cast<std::uint16_t>(std::lround(belief.ignorance * kIgnoranceSteps));
  if (voxel.observations < std::numeric_limits<std::uint16_t>::max()) ++voxel.observations;
  if (voxel.observations == 1 || stamp_ms > voxel.last_seen_ms) voxel.last_seen_ms = stamp_ms;
}

// Eq. (14), for one voxel.
inline void update_voxel(float observation, double credibility, double initial_state,
                         std::uint32_t stamp_ms, Voxel& voxel) {
  const double state = is_known(voxel) ? static_cast<double>(voxel.state) : initial_state;
  store({(1.0 - credibility) * state + credibility * observation}, stamp_ms, voxel);
}

// A voxel that the rule takes for invisible stays as it is, unobserved.
inline void update_voxel(const VisibilityRule& rule, float observation, double visibility,
                         std::uint32_t stamp_ms, Voxel& voxel) {
  if (visibility < rule.min_visibility) return;
  store(rule.after(belief_of(voxel), observation, visibility), stamp_ms, voxel);
}

}  // namespace stereovox
