// What the map knows of one voxel.
#pragma once

#include <cstdint>

namespace stereovox {

struct Voxel {
  float state = 0.0F;              // S in [0, 1]: 0 free, 1 occupied; meaningless where unknown
  std::uint32_t last_seen_ms = 0;  // since the map's epoch
  std::uint16_t observations = 0;  // frames that observed it, saturating; 0 = never observed
  std::uint16_t ignorance = 0;     // m(Theta) of Dempster and Shafer, 0 under the other rules

  bool operator==(const Voxel&) const = default;
};

// The value of Voxel::ignorance that means 1.
inline constexpr double kIgnoranceSteps = 65535.0;

inline bool is_known(const Voxel& voxel) { return voxel.observations > 0; }

}  // namespace stereovox
