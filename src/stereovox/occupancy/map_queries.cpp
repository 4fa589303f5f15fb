#include "stereovox/occupancy/map_queries.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "stereovox/core/grid_geometry.h"
#include "stereovox/occupancy/homogeneity.h"

namespace stereovox {
namespace {

// Finds the voxels of a walk: successive ones mostly lie in the same block.
class NearbyVoxels {
 public:
  explicit NearbyVoxels(const VoxelMap& map) : map_(map) {}

  const PackedVoxel& at(const Eigen::Vector3i& voxel) {
    const Eigen::Vector3i place = block_of(voxel);
    if (place.x() != place_.x() || place.y() != place_.y() || place.z() != place_.z()) {
      place_ = place;
      block_ = map_.find_block(place);
    }
    if (block_ == nullptr) return kUnknownVoxel;
    return block_->voxels.packed(static_cast<std::size_t>(position_in_block(voxel)));
  }

 private:
  const VoxelMap& map_;
  // At first one where no block can be.
  Eigen::Vector3i place_ = Eigen::Vector3i::Constant(kMaxBlockCoordinate + 1);
  const VoxelBlock* block_ = nullptr;
};

// A ray through a map from voxel to voxel (Amanatides and Woo 1987), in voxels. Where it crosses a
// face follows from the face, not from the crossing before, so nothing adds up.
class RayWalk {
 public:
  RayWalk(const VoxelMap& map, const Eigen::Vector3d& from, const Eigen::Vector3d& unit_direction)
      : map_(map), voxel_(from.array().floor().cast<int>()) {
    for (int axis = 0; axis < 3; ++axis) {
      const double direction = unit_direction[axis];
      step_[axis] = direction > 0.0 ? 1 : -1;
      enters_block_at_[axis] = direction > 0.0 ? 0 : kBlockSide - 1;
      // Along an axis that it does not follow it crosses a face infinitely late.
      inverse_[axis] = direction == 0.0 ? 0.0 : 1.0 / direction;
      start_[axis] = direction == 0.0 ? std::numeric_limits<double>::infinity()
                                      : ((direction > 0.0 ? 1.0 : 0.0) - from[axis]) / direction;
      next_[axis] = next_face(axis);
    }
    enter_block();
  }

  const Eigen::Vector3i& index() const { return voxel_; }
  double entered_at() const { return entered_at_; }
  const PackedVoxel& voxel() const {
    return block_ == nullptr ? kUnknownVoxel
                             : block_->voxels.packed(static_cast<std::size_t>(position_));
  }
  // The axis is decided by branches: processors foresee much of a straight line, and then a step
  // need not wait for the faces of the one before.
  void step() {
    if (next_[0] <= next_[1])
      next_[0] <= next_[2] ? cross<0>() : cross<2>();
    else
      next_[1] <= next_[2] ? cross<1>() : cross<2>();
  }

 private:
  double next_face(int axis) const { return voxel_[axis] * inverse_[axis] + start_[axis]; }
  void enter_block() {
    block_ = map_.find_block(block_of(voxel_));
    position_ = position_in_block(voxel_);
  }
  template <int Axis>
  void cross() {
    entered_at_ = next_[Axis];
    voxel_[Axis] += step_[Axis];
    next_[Axis] = next_face(Axis);
    if ((voxel_[Axis] & (kBlockSide - 1)) == enters_block_at_[Axis])
      enter_block();
    else
      position_ += step_[Axis] * (1 << Axis * kBlockSideLog2);
  }

  const VoxelMap& map_;
  const VoxelBlock* block_ = nullptr;
  int position_ = 0;  // in the block
  Eigen::Vector3i voxel_, step_, enters_block_at_;
  Eigen::Vector3d inverse_, start_, next_;
  double entered_at_ = 0.0;
};

// Squared distance from a point to the box [low, high].
double distance2(const Eigen::Vector3d& p, const Eigen::Vector3d& low,
                 const Eigen::Vector3d& high) {
  return (p - p.cwiseMax(low).cwiseMin(high)).squaredNorm();
}

// Calls visit(block) for the blocks `shell` steps from the one in the middle, counted along the
// axis on which they are farthest.
template <class Visit>
void for_each_in_shell(const Eigen::Vector3i& center, int shell, Visit visit) {
  for (int x = -shell; x <= shell; ++x)
    for (int y = -shell; y <= shell; ++y) {
      const bool is_wall = std::abs(x) == shell || std::abs(y) == shell;
      const int step = is_wall || shell == 0 ? 1 : 2 * shell;
      for (int z = -shell; z <= shell; z += step) visit(center + Eigen::Vector3i(x, y, z));
    }
}

}  // namespace

MapQueries::MapQueries(const VoxelMap& map, const QueryParams& params)
    : map_(map), params_(params) {}

std::vector<VoxelState> MapQueries::states_at(std::span<const Eigen::Vector3d> points_world) const {
  // First where some voxels lie, then what they say: their memory is fetched at the same time.
  constexpr std::size_t kAtATime = 32;
  NearbyVoxels voxels(map_);
  std::vector<VoxelState> states(points_world.size());
  std::array<const PackedVoxel*, kAtATime> found;
  for (std::size_t first = 0; first < states.size(); first += kAtATime) {
    const std::size_t count = std::min(kAtATime, states.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      found[i] = &voxels.at(voxel_index_of(map_.voxel_size_m(), points_world[first + i]));
      __builtin_prefetch(found[i]);
    }
    for (std::size_t i = 0; i < count; ++i) states[first + i] = state_of(*found[i]);
  }
  return states;
}

bool MapQueries::is_obstacle(VoxelState state) const {
  if (state == VoxelState::unknown) return params_.unknown == UnknownSpace::is_occupied;
  return state == VoxelState::occupied;
}

std::optional<RayHit> MapQueries::cast_ray(const Eigen::Vector3d& from_world,
                                           const Eigen::Vector3d& direction_world,
                                           double range_m) const {
  if (!from_world.allFinite() || !direction_world.allFinite() || direction_world.isZero(0.0) ||
      !std::isfinite(range_m))
    throw std::logic_error("cast_ray: start, direction or range is not finite, or no direction");
  const double size_m = map_.voxel_size_m();
  for (RayWalk walk(map_, from_world / size_m, direction_world.normalized());
       walk.entered_at() * size_m <= range_m; walk.step()) {
    const VoxelState state = state_of(walk.voxel());
    if (is_obstacle(state)) return RayHit{walk.index(), walk.entered_at() * size_m, state};
  }
  return std::nullopt;
}

// `touches`(low, high) says whether the body meets the box of a voxel or of a block.
template <class Touches>
bool MapQueries::collides(const Eigen::Vector3d& low_world, const Eigen::Vector3d& high_world,
                          Touches touches) const {
  const double size_m = map_.voxel_size_m();
  // A voxel that only shares its upper face with the body counts: both are closed.
  const Eigen::Vector3i first = ((low_world / size_m).array().ceil().cast<int>() - 1).matrix();
  const Eigen::Vector3i last = voxel_index_of(size_m, high_world);
  NearbyVoxels voxels(map_);
  Eigen::Vector3i voxel;
  for (voxel.z() = first.z(); voxel.z() <= last.z(); ++voxel.z())
    for (voxel.y() = first.y(); voxel.y() <= last.y(); ++voxel.y())
      for (voxel.x() = first.x(); voxel.x() <= last.x(); ++voxel.x()) {
        if (!is_obstacle(state_of(voxels.at(voxel)))) continue;
        const Eigen::Vector3d low = voxel.cast<double>() * size_m;
        if (touches(low, Eigen::Vector3d(low.array() + size_m))) return true;
      }
  return false;
}

std::optional<Obstacle> MapQueries::nearest_obstacle(const Eigen::Vector3d& p_world,
                                                     double range_m) const {
  const double block_m = map_.voxel_size_m() * kBlockSide;
  const Eigen::Vector3i center = block_of(voxel_index_of(map_.voxel_size_m(), p_world));
  std::optional<Obstacle> nearest;
  const auto reach = [&] { return nearest ? nearest->distance_m : range_m; };
  // A block of shell s is farther than (s - 1) blocks.
  for (int shell = 0; (shell - 1) * block_m <= reach(); ++shell)
    for_each_in_shell(center, shell, [&](const Eigen::Vector3i& index) {
      const Eigen::Vector3d low = index.cast<double>() * block_m;
      if (distance2(p_world, low, (low.array() + block_m).matrix()) > reach() * reach()) return;
      if (const VoxelBlock* const block = map_.find_block(index))
        search_nearest(*block, p_world, range_m, nearest);
    });
  return nearest;
}

void MapQueries::search_nearest(const VoxelBlock& block, const Eigen::Vector3d& p_world,
                                double range_m, std::optional<Obstacle>& nearest) const {
  const double size_m = map_.voxel_size_m();
  for (int i = 0; i < kVoxelsPerBlock; ++i) {
    if (!is_obstacle(state_of(block.voxels[static_cast<std::size_t>(i)]))) continue;
    const Eigen::Vector3i voxel = voxel_at(block.index, i);
    const Eigen::Vector3d low = voxel.cast<double>() * size_m;
    const double distance_m = std::sqrt(distance2(p_world, low, (low.array() + size_m).matrix()));
    if (distance_m > range_m) continue;
    if (!nearest || distance_m < nearest->distance_m ||
        (distance_m == nearest->distance_m && LatticeOrder{}(voxel, nearest->voxel)))
      nearest = Obstacle{voxel, distance_m};
  }
}

bool MapQueries::box_collides(const Eigen::Vector3d& low_world,
                              const Eigen::Vector3d& high_world) const {
  return collides(low_world, high_world,
                  [](const Eigen::Vector3d&, const Eigen::Vector3d&) { return true; });
}

bool MapQueries::ball_collides(const Eigen::Vector3d& center_world, double radius_m) const {
  const Eigen::Array3d center = center_world.array();
  return collides(center - radius_m, center + radius_m,
                  [&](const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
                    return distance2(center_world, low, high) <= radius_m * radius_m;
                  });
}

std::vector<Eigen::Vector3i> frontier_voxels(const VoxelMap& map, const QueryParams& params,
                                             const VoxelBounds& box) {
  const MapQueries queries(map, params);
  NearbyVoxels voxels(map);
  std::vector<Eigen::Vector3i> frontier;
  const auto is_unknown = [&](const Eigen::Vector3i& voxel) {
    return queries.state_of(voxels.at(voxel)) == VoxelState::unknown;
  };
  for (const VoxelBlock* const block : map.blocks_in(box))
    for (int i = 0; i < kVoxelsPerBlock; ++i) {
      const Eigen::Vector3i voxel = voxel_at(block->index, i);
      if (!box.contains(voxel) ||
          queries.state_of(block->voxels[static_cast<std::size_t>(i)]) != VoxelState::free)
        continue;
      if (std::ranges::any_of(
              neighbour_steps(Neighbourhood::faces),
              [&](const Eigen::Vector3i& step) { return is_unknown(voxel + step); }))
        frontier.push_back(voxel);
    }
  std::ranges::sort(frontier, LatticeOrder{});
  return frontier;
}

}  // namespace stereovox
