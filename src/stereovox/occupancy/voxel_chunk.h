// Some blocks of a voxel map as bytes, and back: the content of one chunk of map.svx, before
// compression (docs/formats.md).
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "stereovox/occupancy/voxel_map.h"

namespace stereovox {

inline constexpr int kMaxBlocksPerChunk = 256;
// Place, mask and voxels of that many full blocks.
inline constexpr std::size_t kMaxChunkBytes =
    kMaxBlocksPerChunk * (3 * 4 + kVoxelsPerBlock / 8 + kVoxelsPerBlock * 10);

// Unknown voxels leave nothing but an empty bit.
std::string encode_chunk(std::span<const VoxelBlock* const> blocks);

struct DecodedChunk {
  std::size_t known_voxels = 0;
  const VoxelBlock* last_block = nullptr;
};

// Adds the blocks to the map. Throws std::runtime_error or std::out_of_range with the fact when the
// bytes are not `block_count` blocks in canonical order after `previous` (nullptr: the first ones).
DecodedChunk decode_chunk(std::string_view bytes, int block_count, const VoxelBlock* previous,
                          VoxelMap& map);

}  // namespace stereovox
