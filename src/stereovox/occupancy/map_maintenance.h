// Changes to a whole map that no measurement asks for: forgetting places, joining maps, making them
// coarser, letting old knowledge fade.
#pragma once

#include <Eigen/Core>

#include "stereovox/core/se3.h"
#include "stereovox/occupancy/voxel_map.h"

namespace stereovox {

// Forgets the voxels in the box, or all others. Voxels are unknown afterwards.
void clear_box(const VoxelBounds& box, VoxelMap& map);
void crop(const VoxelBounds& box, VoxelMap& map);

// Adds what `other` knows, moved by T_map_other, to `map`: each voxel goes to the one that holds
// its moved centre. Two voxels that know the same place become one: the states' mean (and that of
// the ignorance), weighted by the numbers of observations, whose sum (saturating) counts, and the
// later time. Times of `other` are moved to the epoch of `map`; when `map` has none it takes over
// the other's. Throws Error, and leaves `map` as it is, when the voxel sizes differ or a voxel
// would lie beyond the lattice.
void merge(const VoxelMap& other, const SE3& T_map_other, VoxelMap& map);

// The map in voxels `factor` times as large (2, 4, 8, ...). A coarse voxel is as occupied as the
// most occupied voxel in it, so nothing thin is lost, seen as often and as late as the one seen
// most, and known when one of them is. Throws std::logic_error for another factor and Error when
// the voxels become too large.
VoxelMap downsampled(const VoxelMap& map, int factor);

// How far a state fades towards 1/2 in the time that a voxel was not seen.
struct DecayParams {
  double time_constant_s = 600.0;  // tau: a state's distance from 1/2 shrinks by exp(-age / tau)
  // A voxel whose state is nearer to 1/2 than this is forgotten; 0: none is.
  double forget_below = 0.0;
};

// Lets the voxels fade that were not seen for long, as the credibility's age term discounts old
// knowledge (eq. 16, exp(-dt / tau)). `now_ms` counts from the map's epoch; younger voxels stay as
// they are. The time of the last observation stays, so decay once, when the knowledge is needed, or
// on a copy: twice would count the age twice.
void decay(const DecayParams& params, std::uint32_t now_ms, VoxelMap& map);

}  // namespace stereovox
