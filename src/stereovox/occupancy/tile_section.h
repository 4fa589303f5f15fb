// One tile of a map as bytes that tell whether they are intact: a section of map.svx
// (docs/formats.md), and what the tile store holds. Equal tiles have equal bytes.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "stereovox/occupancy/voxel_chunk.h"
#include "stereovox/occupancy/voxel_tile.h"

namespace stereovox {

inline constexpr std::string_view kTileMark = "TILE";

struct TileHead {
  Eigen::Vector3i index = Eigen::Vector3i::Zero();
  VoxelFields fields = VoxelFields::without_ignorance;
  std::uint32_t blocks = 0, known_voxels = 0;  // both more than 0
  std::uint32_t content_bytes = 0, compressed_bytes = 0;

  // Of the section.
  std::size_t bytes() const;
};

// Of a head with mark and checksum, and of the checksum at the end of a section.
inline constexpr std::size_t kTileHeadBytes = 4 + 3 * 4 + 1 + 4 * 4 + 4;
inline constexpr std::size_t kChecksumBytes = 4;

// Blocks of the tile in the canonical order; those without a known voxel are left out. No bytes
// when none is left.
std::string encode_tile(const Eigen::Vector3i& tile, std::span<const VoxelBlock* const> blocks);

// Of the first kTileHeadBytes of a section. Throws std::runtime_error with the fact when they are
// no intact head.
TileHead decode_tile_head(std::string_view bytes);

// The blocks of a whole section, or of what follows its head. Throws std::runtime_error or
// std::out_of_range with the fact.
TileBlocks decode_tile(std::string_view section);
TileBlocks decode_tile_body(const TileHead& head, std::string_view body);

}  // namespace stereovox
