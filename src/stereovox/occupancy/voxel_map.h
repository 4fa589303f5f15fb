// The 3D occupancy map: what is known of each voxel, in blocks of 8 x 8 x 8 that exist only where
// something was observed. It stores and finds; how measurements change it is integrate.h's
// business.
//
//   for (const VoxelBlock* block : map.sorted_blocks())
//     for (int i = 0; i < kVoxelsPerBlock; ++i)
//       if (is_known(block->voxels[i])) use(voxel_at(block->index, i), block->voxels[i]);
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "stereovox/occupancy/block_index.h"

namespace stereovox {

struct Voxel {
  float state = 0.0F;              // S in [0, 1]: 0 free, 1 occupied; meaningless where unknown
  std::uint32_t last_seen_ms = 0;  // since the map's epoch
  std::uint16_t observations = 0;  // frames that observed it, saturating; 0 = never observed
  std::uint16_t ignorance = 0;     // m(Theta) of Dempster and Shafer, 0 under the other rules
};
static_assert(sizeof(Voxel) == 12);

// The value of Voxel::ignorance that means 1.
inline constexpr double kIgnoranceSteps = 65535.0;

inline bool is_known(const Voxel& voxel) { return voxel.observations > 0; }

struct VoxelBlock {
  Eigen::Vector3i index;  // of the block
  std::array<Voxel, kVoxelsPerBlock> voxels;
};

struct VoxelBounds {
  Eigen::Vector3i min, max;  // voxel indices, both included
};

// Voxel i covers [i, i + 1) * voxel_size_m along each axis of the world. Blocks keep their address.
class VoxelMap {
 public:
  // The height of the floor belongs to the map because height limits count from it. Throws Error
  // when the size is not in [0.001, 10] m or the height is not finite.
  explicit VoxelMap(double voxel_size_m, double floor_z_m = 0.0);

  double voxel_size_m() const { return voxel_size_m_; }
  double floor_z_m() const { return floor_z_m_; }

  // The voxel, or nullptr when its block does not exist; a voxel found may still be unknown.
  const Voxel* find(const Eigen::Vector3i& index) const;
  // The voxel; an unknown one when its block does not exist.
  Voxel at(const Eigen::Vector3i& index) const;

  VoxelBlock& find_or_create_block(const Eigen::Vector3i& block_index);
  const VoxelBlock* find_block(const Eigen::Vector3i& block_index) const;
  // In the canonical order (block_index.h), whatever the order of creation.
  std::vector<const VoxelBlock*> sorted_blocks() const;

  std::size_t block_count() const { return blocks_.size(); }
  std::size_t known_voxel_count() const;
  std::optional<VoxelBounds> bounds() const;  // of the known voxels
  std::size_t memory_bytes() const;

  // Time stamp of the first frame integrated; last_seen_ms counts from it.
  std::optional<std::int64_t> epoch_ns;
  std::uint32_t frames_integrated = 0;
  // Named blobs that travel with the map in its file.
  std::map<std::string, std::string> attachments;

 private:
  double voxel_size_m_, floor_z_m_;
  BlockIndex index_;
  std::deque<VoxelBlock> blocks_;
};

}  // namespace stereovox
