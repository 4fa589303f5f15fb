// How visible each voxel that a frame observes is from the camera, through the map as it is before
// the frame (VisibilityRule). From voxel to voxel outward
//   P(V) = P(V of the voxel before) * (P(V|C) q + 1 - q),
// where the voxel before is the one through which the line from the camera to the voxel's centre
// enters it, and q, the probability that the voxel is hidden, that of the least occupied of the up
// to three neighbours that face the camera. A voxel is as if before the camera, P(V) = 1, when it
// holds the camera or the frame did not observe the one before it.
#pragma once

#include <vector>

#include "stereovox/occupancy/frame_observation.h"
#include "stereovox/occupancy/visibility_rule.h"

namespace stereovox {

// The axis across which the line from the camera to the voxel's centre enters the voxel: that along
// which they are farthest apart. `to_camera` = voxel of the camera - voxel, not zero.
int entry_axis(const FrameView& frame, const Eigen::Vector3i& voxel,
               const Eigen::Vector3i& to_camera);

// P(V) by block of the observation and position in the block; 0 where nothing is observed. The same
// for any number of threads.
std::vector<std::vector<float>> frame_visibility(const VisibilityRule& rule, const FrameView& frame,
                                                 const FrameObservation& observation,
                                                 const VoxelMap& map, int threads);

}  // namespace stereovox
