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

// Makes sure before the work that its results can be written. Throws ResourceError when the folder
// cannot be made or written to, UsageError when it holds results already and `overwrite` is false.
void prepare_output_folder(const std::filesystem::path& folder, bool overwrite);

// Each file appears whole or not at all. Throws ResourceError.
void write_outputs(const std::filesystem::path& folder, const StereoSequence& sequence,
                   const PipelineConfig& config, BuildResult& result);

// The navigation map of a voxel map under `yaml_path`, its image (.pgm) and a picture for people
// (.png) beside it.
OccupancyGrid2D write_navigation_map(const std::filesystem::path& yaml_path, const VoxelMap& map,
                                     const SightLines& sight_lines, const WallFaces& wall_faces,
                                     const Trajectory& trajectory, const NavmapParams& params,
                                     MapServerMode mode);

}  // namespace stereovox
