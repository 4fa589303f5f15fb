// A voxel map as a grid of OpenVDB (https://www.openvdb.org), for Blender, Houdini and programs
// that use the library. OpenVDB is optional when stereovox is built.
#pragma once

#include <filesystem>

#include "stereovox/occupancy/map_queries.h"

namespace stereovox {

// Whether this build has OpenVDB.
bool has_openvdb();

// Throws UsageError when it does not; `path` is what was to be written.
void require_openvdb(const std::filesystem::path& path);

// Writes one float grid, "occupancy": the state in [0, 1] of each known voxel. Unknown voxels (and
// those with too few observations) are inactive and have the background's value, 0.5. The transform
// takes the index of a voxel to its centre in the world, metres. Replaces the file in one step; two
// files of one map differ in the random number that OpenVDB gives each. Throws ResourceError when
// the file cannot be written, and as require_openvdb.
void export_openvdb(const std::filesystem::path& path, const VoxelMap& map,
                    const QueryParams& params);

}  // namespace stereovox
