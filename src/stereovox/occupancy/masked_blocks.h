// Sets of voxels, by block.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "stereovox/occupancy/voxel_mask.h"

namespace stereovox {

class MaskedBlocks {
 public:
  // Consecutive voxels mostly lie in the same block.
  void set(const Eigen::Vector3i& voxel) {
    const Eigen::Vector3i block = block_of(voxel);
    if (last_ == BlockIndex::kNone || block != indices_[static_cast<std::size_t>(last_)])
      last_ = number_of(block);
    masks_[static_cast<std::size_t>(last_)].set(position_in_block(voxel));
  }
  void insert(const Eigen::Vector3i& block, const VoxelMask& mask) {
    masks_[static_cast<std::size_t>(number_of(block))] |= mask;
  }
  // Number of the block, which is added when it is new.
  int number_of(const Eigen::Vector3i& block) {
    const int number = index_.find_or_insert(block);
    if (number == static_cast<int>(masks_.size())) {
      indices_.push_back(block);
      masks_.emplace_back();
    }
    return number;
  }

  const BlockIndex& index() const { return index_; }
  const std::vector<Eigen::Vector3i>& indices() const { return indices_; }  // by number
  const std::vector<VoxelMask>& masks() const { return masks_; }            // by number

 private:
  BlockIndex index_;
  std::vector<Eigen::Vector3i> indices_;
  std::vector<VoxelMask> masks_;
  int last_ = BlockIndex::kNone;
};

}  // namespace stereovox
