// map.svx: a voxel map with everything it knows, lossless and checked. The bytes are described in
// docs/formats.md. The same map always gives the same file. Version 3 is written, 1 and 2 are read
// too.
#pragma once

#include <filesystem>
#include <fstream>
#include <istream>
#include <ostream>
#include <string>
#include <vector>

#include "stereovox/occupancy/map_parts.h"
#include "stereovox/occupancy/voxel_map.h"

namespace stereovox {

// Replaces the file in one step, or throws ResourceError and leaves it alone. Throws Error when the
// attachments exceed 64 MiB together. Tiles that are out are copied from the store.
void write_voxel_map(const std::filesystem::path& path, const VoxelMap& map);
void write_voxel_map(std::ostream& out, const VoxelMap& map);

// Throws Error "<path or name>: ..." when the file cannot be opened, is no map, is of a newer
// version, is cut off or damaged in any byte. Allocates only what the file backs with bytes or the
// format allows.
VoxelMap read_voxel_map(const std::filesystem::path& path);
VoxelMap read_voxel_map(std::istream& in, const std::string& name);

// A map file tile by tile: opening it reads no tile.
//
//   VoxelMapTiles file("map.svx");
//   VoxelMap map = file.empty_map();
//   for (const TileListing& tile : file.tiles())
//     if (is_near(tile.index)) file.read(tile, map);
class VoxelMapTiles {
 public:
  // Throws Error as read_voxel_map does, also for versions 1 and 2, which have no tiles.
  explicit VoxelMapTiles(const std::filesystem::path& path);

  const MapHeader& header() const { return end_.header; }
  const std::vector<TileListing>& tiles() const { return tiles_; }  // in the canonical order
  // With the header's facts but without attachments.
  VoxelMap empty_map() const;
  // Adds one tile. Throws Error when it is damaged; the map is then as it was.
  void read(const TileListing& tile, VoxelMap& map);

 private:
  std::ifstream file_;
  MapInput in_;
  MapEnd end_;
  std::vector<TileListing> tiles_;
};

struct SalvagedMap {
  VoxelMap map;
  std::size_t tiles = 0;            // that were intact (versions 1 and 2: blocks)
  std::vector<std::string> losses;  // one line each; empty: the file is intact
};

// All that is intact of a damaged or cut off file: every tile whose checksums fit, of versions 1
// and 2 the blocks before the first damage. Throws Error when no header is left.
SalvagedMap salvage_voxel_map(const std::filesystem::path& path);

}  // namespace stereovox
