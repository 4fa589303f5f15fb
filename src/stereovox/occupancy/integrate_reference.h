// The oracle for integrate(): the same frame update, written as the method says it, one voxel at a
// time in ordered maps. Slow; for tests.
#pragma once

#include "stereovox/occupancy/integrate.h"

namespace stereovox {

// As integrate(); `threads` is ignored.
FrameUpdate integrate_reference(const DisparityImage& disparity, const RectifiedCamera& camera,
                                const SE3& T_world_camera, std::int64_t stamp_ns,
                                const OccupancyParams& params, int threads, VoxelMap& map);

// As smoothed(), pixel by pixel.
DisparityImage smoothed_reference(const DisparityImage& image, const SmoothingParams& params);

}  // namespace stereovox
