// What planners ask of a map: where a ray ends, whether a box or a ball would touch something, what
// is nearest, where the unknown begins (distance_map.h: how far everything is from obstacles). A
// voxel is occupied when its state is above a threshold and it was observed often enough.
//
//   const MapQueries queries(map, {.min_observations = 3});
//   if (const auto hit = queries.cast_ray(eye, direction, 8.0)) use(hit->voxel, hit->distance_m);
//   if (queries.ball_collides(robot, 0.3)) stop();
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "stereovox/core/grid_geometry.h"
#include "stereovox/occupancy/voxel_map.h"

namespace stereovox {

enum class VoxelState { unknown, free, occupied };

// Whether space that nobody saw stops a ray or touches a body.
enum class UnknownSpace { is_free, is_occupied };

struct QueryParams {
  float threshold = 0.5F;    // occupied above it, in [0, 1]
  int min_observations = 1;  // voxels observed in fewer frames are unknown
  UnknownSpace unknown = UnknownSpace::is_free;
};

struct RayHit {
  Eigen::Vector3i voxel;
  double distance_m = 0;  // from the start to where the ray enters the voxel
  VoxelState state = VoxelState::occupied;
};

struct Obstacle {
  Eigen::Vector3i voxel;
  double distance_m = 0;  // to the nearest point of its cube; 0 inside
};

// Refers to the map, which must not change while a query runs. A query costs the voxels it meets.
class MapQueries {
 public:
  explicit MapQueries(const VoxelMap& map, const QueryParams& params = {});

  VoxelState state_of(const Voxel& voxel) const { return state(voxel.state, voxel.observations); }
  VoxelState state_of(const PackedVoxel& voxel) const {
    return state(voxel.state, voxel.observations);
  }
  VoxelState state_at(const Eigen::Vector3d& p_world) const {
    return state_of(map_.packed_at(voxel_index_of(map_.voxel_size_m(), p_world)));
  }
  std::vector<VoxelState> states_at(std::span<const Eigen::Vector3d> points_world) const;

  // The first voxel on the ray that is occupied, or unknown when that counts as occupied, up to
  // `range_m` > 0; nothing when there is none. `direction` need not have length 1. Throws
  // std::logic_error when it is zero or anything is not finite.
  std::optional<RayHit> cast_ray(const Eigen::Vector3d& from_world,
                                 const Eigen::Vector3d& direction_world, double range_m) const;

  // The nearest voxel that counts as an obstacle by QueryParams, of those with a point within
  // `range_m` of `p_world`; of several the first in the canonical order. Unknown space counts only
  // in blocks that exist.
  std::optional<Obstacle> nearest_obstacle(const Eigen::Vector3d& p_world, double range_m) const;

  // Whether a voxel that counts as occupied has a point in common with the closed box or ball.
  bool box_collides(const Eigen::Vector3d& low_world, const Eigen::Vector3d& high_world) const;
  bool ball_collides(const Eigen::Vector3d& center_world, double radius_m) const;

 private:
  VoxelState state(float state, int observations) const {
    // Without a branch: a wrong guess would be known only when the voxel's memory has come.
    const int is_seen = (observations > 0) & (observations >= params_.min_observations);
    const int is_above = state > params_.threshold;
    static_assert(int(VoxelState::free) == 1 && int(VoxelState::occupied) == 2);
    return static_cast<VoxelState>(is_seen * (1 + is_above));
  }
  bool is_obstacle(VoxelState state) const;
  void search_nearest(const VoxelBlock& block, const Eigen::Vector3d& p_world, double range_m,
                      std::optional<Obstacle>& nearest) const;
  template <class Touches>
  bool collides(const Eigen::Vector3d& low_world, const Eigen::Vector3d& high_world,
                Touches touches) const;

  const VoxelMap& map_;
  QueryParams params_;
};

// The free voxels in the box with an unknown one behind one of their six faces, in the canonical
// order: where a robot that explores learns more.
std::vector<Eigen::Vector3i> frontier_voxels(const VoxelMap& map, const QueryParams& params,
                                             const VoxelBounds& box);

}  // namespace stereovox
