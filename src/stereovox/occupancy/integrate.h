// Adds one stereo frame to the map: the observation and update of method.md A.21, steps 1 to 5,
// with the update rule that the parameters name (update_rules.h).
//
//   VoxelMap map(params.voxel_size_m, floor_z_m);
//   const FrameUpdate update = integrate(disparity, camera, T_world_camera, stamp_ns, params, 2,
//   map);
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "stereovox/core/camera.h"
#include "stereovox/core/image.h"
#include "stereovox/core/se3.h"
#include "stereovox/occupancy/occupancy_params.h"
#include "stereovox/occupancy/voxel_map.h"

namespace stereovox {

// What a frame did to the map.
struct FrameUpdate {
  int hit_voxels = 0;                 // observed as occupied: O_t > 0.02, by a profile > 0.48
  int free_voxels = 0;                // observed as free: all other
  int points_used = 0;                // measurements that mark a surface
  std::vector<Eigen::Vector3i> hits;  // the hit voxels, in the canonical order (block_index.h)
};

// Each observed voxel changes once by its O_t and the rule. A voxel both hit and crossed
// by rays counts as hit; pixels without disparity say nothing. The map that results is bit by bit
// the same for any number of threads and equals integrate_reference's. The frame's stamp must not
// be before the map's first one. Errors: see view_frame; the map is then unchanged.
FrameUpdate integrate(const DisparityImage& disparity, const RectifiedCamera& camera,
                      const SE3& T_world_camera, std::int64_t stamp_ns,
                      const OccupancyParams& params, int threads, VoxelMap& map);

}  // namespace stereovox
