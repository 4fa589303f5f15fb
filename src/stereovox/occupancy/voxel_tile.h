// The map cut into tiles of 4 x 4 x 4 blocks: the unit that is stored, read and checked on its own.
// Block (i, j, k) lies in tile (i >> 2, j >> 2, k >> 2).
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "stereovox/occupancy/tile_store.h"
#include "stereovox/occupancy/voxel_block.h"

namespace stereovox {

inline constexpr int kTileSideLog2 = 2;
inline constexpr int kTileSide = 1 << kTileSideLog2;  // in blocks
inline constexpr int kBlocksPerTile = kTileSide * kTileSide * kTileSide;

inline Eigen::Vector3i tile_of(const Eigen::Vector3i& block) {
  return {block.x() >> kTileSideLog2, block.y() >> kTileSideLog2, block.z() >> kTileSideLog2};
}

// In the canonical order of the blocks: by x, then y, then z.
inline std::size_t position_in_tile(const Eigen::Vector3i& block) {
  constexpr int kInside = kTileSide - 1;
  return static_cast<std::size_t>((block.x() & kInside) << 2 * kTileSideLog2 |
                                  (block.y() & kInside) << kTileSideLog2 | (block.z() & kInside));
}

inline Eigen::Vector3i block_at(const Eigen::Vector3i& tile, std::size_t position) {
  constexpr int kInside = kTileSide - 1;
  const int p = static_cast<int>(position);
  return tile * kTileSide +
         Eigen::Vector3i(p >> 2 * kTileSideLog2, p >> kTileSideLog2 & kInside, p & kInside);
}

using TileBlocks = std::array<std::unique_ptr<VoxelBlock>, kBlocksPerTile>;

// Blocks in the canonical order.
inline std::vector<const VoxelBlock*> blocks_of(const TileBlocks& blocks) {
  std::vector<const VoxelBlock*> existing;
  for (const auto& block : blocks)
    if (block != nullptr) existing.push_back(block.get());
  return existing;
}

// How often a map was touched up to some moment.
using ChangeStamp = std::uint64_t;

// Known voxels, and the blocks that have one.
struct KnownCounts {
  std::size_t blocks = 0, voxels = 0;

  KnownCounts& operator+=(const KnownCounts& other) {
    blocks += other.blocks;
    voxels += other.voxels;
    return *this;
  }
};

struct VoxelTile {
  Eigen::Vector3i index;
  bool is_out = false;  // in the store only
  TileBlocks blocks;    // all nullptr while the tile is out
  std::array<ChangeStamp, kBlocksPerTile> changed_at{};
  ChangeStamp used_at = 0;  // of the last change or the return from the store

  // Where the store holds the tile, and what is in it; nothing there: place.bytes == 0.
  StoredPlace stored;
  ChangeStamp stored_at = 0;  // changes up to this one are stored
  KnownCounts stored_known;

  bool is_measured = true;  // memory_bytes is up to date
  std::size_t memory_bytes = 0;
};

}  // namespace stereovox
