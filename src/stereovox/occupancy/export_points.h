// A voxel map as a point cloud: the centre of each voxel with its occupancy, for MeshLab,
// CloudCompare, PCL and the like.
#pragma once

#include <filesystem>
#include <ostream>

#include "stereovox/occupancy/map_queries.h"

namespace stereovox {

enum class PointForm { ply, pcd };

// Which voxels become points.
enum class ExportedVoxels { occupied, known };

// Binary PLY (x y z in metres and the state in [0, 1] as floats, and a colour by the height above
// the floor) or PCD 0.7 (x y z occupancy), in the canonical order of tiles and blocks. Replaces the
// file in one step; the extension chooses the form. Throws Error when it is neither, ResourceError
// when the file cannot be written.
void export_points(const std::filesystem::path& path, const VoxelMap& map,
                   const QueryParams& params, ExportedVoxels which);
void export_points(std::ostream& out, PointForm form, const VoxelMap& map,
                   const QueryParams& params, ExportedVoxels which);

}  // namespace stereovox
