#include "stereovox/pipeline/outputs.h"

#include <fmt/format.h>

#include "stereovox/core/error.h"
#include "stereovox/io/atomic_file.h"
#include "stereovox/io/image_file.h"
#include "stereovox/io/trajectory_file.h"
#include "stereovox/navmap/draw_map.h"
#include "stereovox/navmap/project_to_2d.h"
#include "stereovox/navmap/write_map_server.h"
#include "stereovox/occupancy/voxel_map_file.h"
#include "stereovox/pipeline/report.h"

namespace stereovox {
namespace {

namespace fs = std::filesystem;

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    throw ResourceError(fmt::format("{}: cannot be made: {}", folder.string(), error.message()));
}

// Threads and memory never change results, so they must not change the map's bytes.
std::string yaml_without_resources(PipelineConfig config) {
  config.threads = 0;
  config.memory_limit_mb = 0.0;
  return to_yaml(config);
}

// They are dear where hedges line kilometres of road; a map without them is still a map.
void attach(const WallFaces& faces, VoxelMap& map, std::vector<std::string>& warnings) {
  constexpr std::size_t kMaxBytes = std::size_t{32} << 20;
  if (faces.is_empty()) return;
  std::string bytes = to_bytes(faces);
  if (bytes.size() <= kMaxBytes)
    map.attachments[kWallFacesAttachment] = std::move(bytes);
  else
    warnings.push_back(
        fmt::format("map.svx is written without wall faces, which take {} of at most {} bytes: "
                    "other "
                    "navigation maps made of it will place walls by contrast alone",
                    bytes.size(), kMaxBytes));
}

void write_segment(const fs::path& folder, const PipelineConfig& config, MapSegment& segment,
                   std::vector<std::string>& warnings) {
  make_folder(folder);
  segment.map.attachments["config.yaml"] = yaml_without_resources(config);
  segment.map.attachments[kSightLinesAttachment] = to_bytes(segment.sight_lines);
  attach(segment.wall_faces, segment.map, warnings);
  write_voxel_map(folder / "map.svx", segment.map);
  write_tum(folder / "trajectory.tum", segment.trajectory,
            "left rectified camera (x right, y down, z forward) in the world (z up)");
  write_kitti_poses(folder / "trajectory_kitti.txt", segment.trajectory);
  try {
    write_navigation_map(folder / "nav.yaml", segment.map, segment.sight_lines, segment.wall_faces,
                         segment.trajectory, config.navmap, MapServerMode::trinary);
  } catch (const ResourceError&) {
    throw;
  } catch (const Error& error) {  // too wide: no reason to lose all else
    warnings.push_back(std::string("there is no navigation map: ") + error.what());
  }
}

}  // namespace

void write_outputs(const fs::path& folder, const StereoSequence& sequence,
                   const PipelineConfig& config, BuildResult& result) {
  write_segment(folder, config, result.segments.front(), result.warnings);
  for (std::size_t i = 1; i < result.segments.size(); ++i)
    write_segment(folder / fmt::format("segment_{}", i + 1), config, result.segments[i],
                  result.warnings);
  write_text_atomically(folder / "config.yaml", to_yaml(config));
  write_text_atomically(folder / "report.json", report(sequence, config, result).dump(2) + "\n");
}

OccupancyGrid2D write_navigation_map(const fs::path& yaml_path, const VoxelMap& map,
                                     const SightLines& sight_lines, const WallFaces& wall_faces,
                                     const Trajectory& trajectory, const NavmapParams& params,
                                     MapServerMode mode) {
  OccupancyGrid2D grid = project_to_2d(map, sight_lines, params, wall_faces);
  std::vector<Eigen::Vector2d> path;
  for (const StampedPose& pose : trajectory)
    path.emplace_back(pose.T_world_camera.translation.head<2>());
  write_map_server(yaml_path, grid, mode);
  write_png(fs::path(yaml_path).replace_extension(".png"), draw_map(grid, path));
  return grid;
}

}  // namespace stereovox
