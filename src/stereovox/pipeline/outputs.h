// The files that a run leaves, always under the same names:
//
//   map.svx  nav.pgm  nav.yaml  nav.png  trajectory.tum  trajectory_kitti.txt  report.json
//   config.yaml
//
// and the same map and trajectory files for each further segment in segment_<n>/.
#pragma once

#include <filesystem>

#include "stereovox/dataset/stereo_sequence.h"
#include "stereovox/navmap/map_server.h"
#include "stereovox/navmap/occupancy_grid_2d.h"
#include "stereovox/pipeline/build_maps.h"

namespace stereovox {

// Each file appears whole or not at all. A navigation map that would be too wide is left out, with
// a warning in the result. Throws ResourceError.
void write_outputs(const std::filesystem::path& folder, const StereoSequence& sequence,
                   const PipelineConfig& config, BuildResult& result);

// The navigation map of a voxel map under `yaml_path`, its image (.pgm) and a picture for people
// (.png) beside it.
OccupancyGrid2D write_navigation_map(const std::filesystem::path& yaml_path, const VoxelMap& map,
                                     const SightLines& sight_lines, const WallFaces& wall_faces,
                                     const Trajectory& trajectory, const NavmapParams& params,
                                     MapServerMode mode);

}  // namespace stereovox
