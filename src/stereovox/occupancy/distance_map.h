// How far the nearest obstacle is, for planners that ask often: a truncated Euclidean distance
// field of a map, in space or in the plane, brought up to date by what changed in the map.
//
//   DistanceMap clearance(map, {.max_distance_m = 1.0});
//   for each frame: { integrate(..., map); clearance.update(map, threads); }
//   if (clearance.distance_m(p_world) < 0.3) avoid(p_world);
//
// Obstacles are the occupied voxels, whatever QueryParams say of unknown ones. A distance is that
// between the centre of the voxel that was asked for and the nearest obstacle's centre, exactly; a
// body of radius r is free of obstacles when it exceeds r by a voxel's diagonal.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "stereovox/occupancy/map_queries.h"
#include "stereovox/occupancy/truncated_distances.h"

namespace stereovox {

struct DistanceMapParams {
  double max_distance_m = 1.0;  // no distance exceeds it; at most 100 voxels
  // Only voxels with their centres at these heights (z of the world) are obstacles, and the field
  // is that of their places in the plane. Without: the field is that of space.
  struct Band {
    double low_m, high_m;
  };
  std::optional<Band> plane = std::nullopt;
  QueryParams query = {};
};

class DistanceMap {
 public:
  // An empty field for maps of this voxel size. Throws std::logic_error when the greatest distance
  // is not positive or exceeds 100 voxels.
  DistanceMap(double voxel_size_m, const DistanceMapParams& params);

  // Takes over what changed in the map since the last time. Always give it the same map. The result
  // does not depend on the threads.
  void update(const VoxelMap& map, int threads);

  // In metres, at most max_distance_m; in the plane z does not count.
  double distance_m(const Eigen::Vector3d& p_world) const;
  // The square of the distance in voxels, or TruncatedDistances::kBeyond.
  std::uint16_t squared_voxels(const Eigen::Vector3i& voxel) const;

  std::size_t memory_bytes() const { return distances_.memory_bytes(); }

 private:
  VoxelMask obstacles_in(const VoxelMap& map, const Eigen::Vector3i& block) const;
  VoxelMask obstacles_in_column(const VoxelMap& map, const Eigen::Vector3i& column) const;

  double voxel_size_m_;
  DistanceMapParams params_;
  int first_layer_ = 0, last_layer_ = 0;  // of the band
  TruncatedDistances distances_;
  ChangeStamp seen_ = 0;
};

}  // namespace stereovox
