// Some blocks of a voxel map as bytes, and back: the content of one part of map.svx, before
// compression (docs/formats.md).
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "stereovox/occupancy/voxel_block.h"

namespace stereovox {

// What is stored of a voxel: all but its ignorance, or everything.
enum class VoxelFields { without_ignorance, all };

// Place, mask and voxels of that many full blocks.
constexpr std::size_t max_chunk_bytes(VoxelFields fields, int blocks) {
  const int voxel_bytes = fields == VoxelFields::all ? 12 : 10;
  return static_cast<std::size_t>(blocks) *
         (3 * 4 + kVoxelsPerBlock / 8 + static_cast<std::size_t>(kVoxelsPerBlock * voxel_bytes));
}

// Unknown voxels leave nothing but an empty bit.
std::string encode_chunk(std::span<const VoxelBlock* const> blocks, VoxelFields fields);

struct DecodedChunk {
  std::size_t known_voxels = 0;
  std::optional<Eigen::Vector3i> last_block;
};

// Gives the block of that place, which must be empty.
using NewBlock = std::function<VoxelBlock&(const Eigen::Vector3i& block)>;

// Fills the blocks. Throws std::runtime_error or std::out_of_range with the fact when the bytes are
// not `block_count` blocks in canonical order after `previous`.
DecodedChunk decode_chunk(std::string_view bytes, VoxelFields fields, int block_count,
                          const std::optional<Eigen::Vector3i>& previous,
                          const NewBlock& new_block);

}  // namespace stereovox
