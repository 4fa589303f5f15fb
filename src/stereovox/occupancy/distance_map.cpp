#include "stereovox/occupancy/distance_map.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "stereovox/core/grid_geometry.h"

namespace stereovox {
namespace {

constexpr int kMaxLayer = kMaxBlockCoordinate * kBlockSide;

int layer_within_reach(double layer) {
  return static_cast<int>(std::clamp(layer, -1.0 * kMaxLayer, 1.0 * kMaxLayer));
}

}  // namespace

DistanceMap::DistanceMap(double voxel_size_m, const DistanceMapParams& params)
    : voxel_size_m_(voxel_size_m),
      params_(params),
      distances_(params.max_distance_m / voxel_size_m, params.plane
                                                           ? TruncatedDistances::Extent::plane
                                                           : TruncatedDistances::Extent::space) {
  if (!params.plane) return;
  // The centre of layer z is at (z + 1/2) * voxel size.
  first_layer_ = layer_within_reach(std::ceil(params.plane->low_m / voxel_size_m - 0.5));
  last_layer_ = layer_within_reach(std::floor(params.plane->high_m / voxel_size_m - 0.5));
}

VoxelMask DistanceMap::obstacles_in(const VoxelMap& map, const Eigen::Vector3i& index) const {
  VoxelMask obstacles;
  const VoxelBlock* const block = map.find_block(index);
  if (block == nullptr) return obstacles;
  const MapQueries queries(map, params_.query);
  for (int i = 0; i < kVoxelsPerBlock; ++i)
    if (queries.state_of(block->voxels[static_cast<std::size_t>(i)]) == VoxelState::occupied)
      obstacles.set(i);
  return obstacles;
}

// The first word of a mask is the layer z = 0.
VoxelMask DistanceMap::obstacles_in_column(const VoxelMap& map,
                                           const Eigen::Vector3i& column) const {
  VoxelMask flat;
  for (int layer = first_layer_; layer <= last_layer_;) {
    const Eigen::Vector3i block(column.x(), column.y(), layer >> kBlockSideLog2);
    const VoxelMask obstacles = obstacles_in(map, block);
    const int end = std::min(last_layer_ + 1, (block.z() + 1) * kBlockSide);
    for (; layer < end; ++layer)
      flat.words[0] |= obstacles.words[static_cast<std::size_t>(layer & (kBlockSide - 1))];
  }
  return flat;
}

void DistanceMap::update(const VoxelMap& map, int threads) {
  const ChangeStamp now = map.change_stamp();
  std::vector<BlockOfSet> changed;
  std::set<Eigen::Vector3i, LatticeOrder> columns;
  for (const Eigen::Vector3i& block : map.blocks_changed_since(seen_)) {
    if (params_.plane)
      columns.insert({block.x(), block.y(), 0});
    else
      changed.push_back({block, obstacles_in(map, block)});
  }
  for (const Eigen::Vector3i& column : columns)
    changed.push_back({column, obstacles_in_column(map, column)});
  distances_.update(changed, threads);
  seen_ = now;
}

std::uint16_t DistanceMap::squared_voxels(const Eigen::Vector3i& voxel) const {
  return distances_.squared_at(params_.plane ? Eigen::Vector3i(voxel.x(), voxel.y(), 0) : voxel);
}

double DistanceMap::distance_m(const Eigen::Vector3d& p_world) const {
  const std::uint16_t squared = squared_voxels(voxel_index_of(voxel_size_m_, p_world));
  if (squared == TruncatedDistances::kBeyond) return params_.max_distance_m;
  return std::sqrt(static_cast<double>(squared)) * voxel_size_m_;
}

}  // namespace stereovox
