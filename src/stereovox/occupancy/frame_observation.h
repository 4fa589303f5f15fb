// Steps 1 to 4 of the pipeline (method.md A.21): the observation O_t of each voxel that one frame
// observes, block by block. The result does not depend on the number of threads.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "stereovox/occupancy/frame_view.h"
#include "stereovox/occupancy/voxel_mask.h"

namespace stereovox {

struct BlockObservation {
  Eigen::Vector3i index;
  VoxelMask observed, hit;    // hit is a part of observed
  std::vector<float> values;  // O_t by position, kUnobserved where not; empty = all are 0

  float value_at(int position) const {
    if (!values.empty()) return values[static_cast<std::size_t>(position)];
    return observed.contains(position) ? 0.0F : kUnobserved;
  }
};

struct FrameObservation {
  BlockIndex index;  // numbers `blocks`
  std::vector<BlockObservation> blocks;
  int points_used = 0;  // measurements that mark a surface
};

FrameObservation observe_frame(const FrameView& frame, const VoxelMap& map, int threads);

}  // namespace stereovox
