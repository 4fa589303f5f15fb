#include "stereovox/occupancy/voxel_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "stereovox/core/error.h"

namespace stereovox {
namespace {

constexpr double kMinVoxelSize_m = 0.001, kMaxVoxelSize_m = 10.0;

bool is_within_reach(const Eigen::Vector3i& block) {
  return (block.array() >= -kMaxBlockCoordinate).all() &&
         (block.array() <= kMaxBlockCoordinate).all();
}

}  // namespace

VoxelMap::VoxelMap(double voxel_size_m, double floor_z_m)
    : voxel_size_m_(voxel_size_m), floor_z_m_(floor_z_m) {
  if (!(voxel_size_m >= kMinVoxelSize_m && voxel_size_m <= kMaxVoxelSize_m))
    throw Error(fmt::format("voxel size is {} m, outside [{}, {}]", voxel_size_m, kMinVoxelSize_m,
                            kMaxVoxelSize_m));
  if (!std::isfinite(floor_z_m)) throw Error(fmt::format("height of the floor is {} m", floor_z_m));
}

const VoxelBlock* VoxelMap::find_block(const Eigen::Vector3i& block_index) const {
  if (!is_within_reach(block_index)) return nullptr;
  const int number = index_.find(block_index);
  return number == BlockIndex::kNone ? nullptr : &blocks_[static_cast<std::size_t>(number)];
}

VoxelBlock& VoxelMap::find_or_create_block(const Eigen::Vector3i& block_index) {
  const auto number = static_cast<std::size_t>(index_.find_or_insert(block_index));
  if (number == blocks_.size()) blocks_.push_back({block_index, {}});
  return blocks_[number];
}

const Voxel* VoxelMap::find(const Eigen::Vector3i& index) const {
  const VoxelBlock* const block = find_block(block_of(index));
  return block == nullptr ? nullptr
                          : &block->voxels[static_cast<std::size_t>(position_in_block(index))];
}

Voxel VoxelMap::at(const Eigen::Vector3i& index) const {
  const Voxel* const voxel = find(index);
  return voxel == nullptr ? Voxel{} : *voxel;
}

std::vector<const VoxelBlock*> VoxelMap::sorted_blocks() const {
  std::vector<const VoxelBlock*> sorted;
  sorted.reserve(blocks_.size());
  for (const VoxelBlock& block : blocks_) sorted.push_back(&block);
  std::ranges::sort(sorted, LatticeOrder{}, &VoxelBlock::index);
  return sorted;
}

std::size_t VoxelMap::known_voxel_count() const {
  std::size_t count = 0;
  for (const VoxelBlock& block : blocks_)
    count += static_cast<std::size_t>(std::ranges::count_if(block.voxels, is_known));
  return count;
}

std::optional<VoxelBounds> VoxelMap::bounds() const {
  std::optional<VoxelBounds> bounds;
  for (const VoxelBlock& block : blocks_)
    for (int i = 0; i < kVoxelsPerBlock; ++i) {
      if (!is_known(block.voxels[static_cast<std::size_t>(i)])) continue;
      const Eigen::Vector3i voxel = voxel_at(block.index, i);
      if (!bounds) bounds = VoxelBounds{voxel, voxel};
      bounds->min = bounds->min.cwiseMin(voxel);
      bounds->max = bounds->max.cwiseMax(voxel);
    }
  return bounds;
}

std::size_t VoxelMap::memory_bytes() const {
  return blocks_.size() * sizeof(VoxelBlock) + index_.memory_bytes();
}

}  // namespace stereovox
