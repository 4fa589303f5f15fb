// A voxel map as an octree file of OctoMap (https://octomap.github.io): .bt keeps whether a voxel
// is free or occupied, .ot its log-odds. Both hold the pruned tree as OctoMap writes it.
#pragma once

#include <filesystem>
#include <ostream>

#include "stereovox/occupancy/map_queries.h"

namespace stereovox {

// Unknown voxels (and those with too few observations) are left out. In .ot a state p becomes
// log(p / (1 - p)) with p held within [0.001, 0.999], positive for occupied voxels only, so that
// OctoMap calls occupied what `params` does when the threshold is 0.5. Replaces the file in one
// step; the extension chooses the form. Throws Error when a voxel lies outside OctoMap's +-32768
// voxels or the extension is neither, ResourceError when the file cannot be written.
void export_octomap(const std::filesystem::path& path, const VoxelMap& map,
                    const QueryParams& params);

enum class OctomapForm { binary, full };  // .bt, .ot
void export_octomap(std::ostream& out, OctomapForm form, const VoxelMap& map,
                    const QueryParams& params);

}  // namespace stereovox
