// The first bytes of map.svx, the same in every version (docs/formats.md).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "stereovox/occupancy/voxel_map.h"

namespace stereovox {

// Versions 1 and 2 (which has ignorance) hold chunks of blocks; 3 holds tiles.
inline constexpr std::uint16_t kFirstMapVersion = 1, kVersionWithIgnorance = 2,
                               kVersionWithTiles = 3;

struct MapHeader {
  std::uint16_t version = kVersionWithTiles;
  double voxel_size_m = 0, floor_z_m = 0;
  std::uint8_t has_epoch = 0;
  std::int64_t epoch_ns = 0;
  std::uint32_t frames_integrated = 0;
  std::uint64_t blocks = 0, known_voxels = 0;
  std::uint32_t attachments = 0;
};

inline constexpr std::string_view kMapMagic = "STEREOVOX-MAP\n";
// Magic and version; and these with all fields and a checksum.
inline constexpr std::size_t kMapStartBytes = 14 + 2, kMapHeaderBytes = kMapStartBytes + 49 + 4;

std::string encode_header(const MapHeader& header);

// Throws std::runtime_error with the fact: of the first kMapStartBytes, whether this is a map of a
// version that is known; and of kMapHeaderBytes, whether they are intact.
std::uint16_t decode_version(std::string_view bytes);
MapHeader decode_header(std::string_view bytes);

// An empty map with the header's size, floor, epoch and frames. Throws std::runtime_error.
VoxelMap empty_map(const MapHeader& header);

}  // namespace stereovox
