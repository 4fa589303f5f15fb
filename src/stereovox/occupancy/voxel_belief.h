// What a voxel believes, as the update rules see it.
#pragma once

namespace stereovox {

struct VoxelBelief {
  double state = 0.5;      // in [0, 1]: 0 free, 1 occupied, 0.5 either
  double ignorance = 0.0;  // m(Theta) of Dempster and Shafer; rules that keep none give 0
};

// Before the first observation.
inline constexpr VoxelBelief kNoBelief{.state = 0.5, .ignorance = 1.0};

}  // namespace stereovox
