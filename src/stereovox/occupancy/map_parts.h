// The parts of map.svx beside its header and its tiles (docs/formats.md): attachments, the chunks
// of blocks of versions 1 and 2, and the index of tiles at the end of version 3.
#pragma once

#include <string>
#include <vector>

#include "stereovox/occupancy/map_header.h"
#include "stereovox/occupancy/map_input.h"

namespace stereovox {

// The floor, where the map has seen it, is attached to the file like what others have attached to
// the map. Throws Error when the attachments exceed 64 MiB together.
std::string encode_attachments(const VoxelMap& map);
std::uint32_t attachment_count(const VoxelMap& map);
void take_attachments(MapInput& in, std::uint32_t count, VoxelMap& map);

// The blocks of versions 1 and 2, chunk by chunk, until the header's number is reached. Blocks that
// were read before an Error stay in the map.
void take_chunks(MapInput& in, const MapHeader& header, VoxelMap& map);

// Where a tile's section stands in the file.
struct TileListing {
  Eigen::Vector3i index = Eigen::Vector3i::Zero();
  std::uint64_t offset = 0;
  std::uint32_t bytes = 0, blocks = 0, known_voxels = 0;

  bool operator==(const TileListing&) const = default;
};

// The last bytes of the file: where the index stands, and the header once more, for a reader that
// finds the first one damaged.
struct MapEnd {
  MapHeader header;
  std::uint64_t index_offset = 0, tiles = 0;
};

inline constexpr std::size_t kMapEndBytes = kMapHeaderBytes + 8 + 8 + 4 + 14;
inline constexpr std::size_t kListingBytes = 3 * 4 + 8 + 3 * 4;

std::string encode_index(const std::vector<TileListing>& tiles);
std::string encode_end(const MapEnd& end);

// Throw Error "<name>: index ..." and "<name>: end ...".
std::vector<TileListing> take_index(MapInput& in, std::uint64_t tiles);
MapEnd take_end(MapInput& in);

}  // namespace stereovox
