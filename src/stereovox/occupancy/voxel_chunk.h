// Some blocks of a voxel map as bytes, and back: the content of one chunk of map.svx, before
// compression (docs/formats.md).
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "stereovox/occupancy/voxel_map.h"

namespace stereovox {

// What is stored of a voxel: all but its ignorance (version 1 of the file), or everything (version
// 2).
enum class VoxelFields { without_ignorance, all };

inline constexpr int kMaxBlocksPerChunk = 256;

// Place, mask and voxels of that many full blocks.
constexpr std::size_t max_chunk_bytes(VoxelFields fields) {
  const int voxel_bytes = fields == VoxelFields::all ? 12 : 10;
  return static_cast<std::size_t>(kMaxBlocksPerChunk) *
         (3 * 4 + kVoxelsPerBlock / 8 + static_cast<std::size_t>(kVoxelsPerBlock * voxel_bytes));
}

// Unknown voxels leave nothing but an empty bit.
std::string encode_chunk(std::span<const VoxelBlock* const> blocks, VoxelFields fields);

struct DecodedChunk {
  std::size_t known_voxels = 0;
  const VoxelBlock* last_block = nullptr;
};

// Adds the blocks to the map. Throws std::runtime_error or std::out_of_range with the fact when the
// bytes are not `block_count` blocks in canonical order after `previous` (nullptr: the first ones).
DecodedChunk decode_chunk(std::string_view bytes, VoxelFields fields, int block_count,
                          const VoxelBlock* previous, VoxelMap& map);

}  // namespace stereovox
