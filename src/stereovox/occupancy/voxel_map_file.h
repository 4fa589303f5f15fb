// map.svx: a voxel map with everything it knows, lossless and checked. The bytes are described in
// docs/formats.md. The same map always gives the same file. Versions 1 and 2 are read; version 2 is
// written only of a map whose voxels have ignorance.
#pragma once

#include <filesystem>
#include <istream>
#include <ostream>
#include <string>

#include "stereovox/occupancy/voxel_map.h"

namespace stereovox {

// Replaces the file in one step, or throws ResourceError and leaves it alone. Throws Error when the
// attachments exceed 64 MiB together.
void write_voxel_map(const std::filesystem::path& path, const VoxelMap& map);
void write_voxel_map(std::ostream& out, const VoxelMap& map);

// Throws Error "<path or name>: ..." when the file cannot be opened, is no map, is of a newer
// version, is cut off or damaged in any byte. Allocates only what the file backs with bytes or the
// format allows.
VoxelMap read_voxel_map(const std::filesystem::path& path);
VoxelMap read_voxel_map(std::istream& in, const std::string& name);

}  // namespace stereovox
