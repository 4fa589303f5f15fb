// stereovox merge A.svx B.svx -o C.svx: two maps as one.
#include <fmt/format.h>

#include <iostream>
#include <memory>
#include <numbers>

#include "command.h"
#include "stereovox/core/error.h"
#include "stereovox/navmap/sight_lines.h"
#include "stereovox/navmap/wall_faces.h"
#include "stereovox/occupancy/map_maintenance.h"
#include "stereovox/occupancy/voxel_map_file.h"

namespace stereovox {
namespace {

struct MergeOptions {
  std::string first, second, output;
  std::vector<double> placement = {0.0, 0.0, 0.0, 0.0};
};

SE3 pose_of(const std::vector<double>& placement) {
  const double yaw_rad = placement[3] * std::numbers::pi / 180.0;
  return {Eigen::Quaterniond(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ())),
          {placement[0], placement[1], placement[2]}};
}

// What navigation maps need besides voxels. Anything else tells of one run, and stays if both tell
// the same.
void merge_attachments(const MergeOptions& options, const VoxelMap& other, VoxelMap& map) {
  const SE3 T_map_other = pose_of(options.placement);
  const double size_m = map.voxel_size_m();
  SightLines sight_lines = attached_sight_lines(map, options.first);
  sight_lines.merge(attached_sight_lines(other, options.second), T_map_other, size_m);
  WallFaces faces = attached_wall_faces(map, options.first);
  if (!faces.merge(attached_wall_faces(other, options.second), T_map_other, size_m))
    warn(
        fmt::format("{}: its wall faces are left out, since it is not moved by whole voxels alone: "
                    "navigation maps will place its walls by contrast",
                    options.second));
  std::erase_if(map.attachments, [&](const auto& attached) {
    const auto found = other.attachments.find(attached.first);
    return found == other.attachments.end() || found->second != attached.second;
  });
  map.attachments[kSightLinesAttachment] = to_bytes(sight_lines);
  if (!faces.is_empty()) map.attachments[kWallFacesAttachment] = to_bytes(faces);
}

ExitCode run(const MergeOptions& options) {
  require_output(options.output);
  VoxelMap map = read_voxel_map(options.first);
  const VoxelMap other = read_voxel_map(options.second);
  try {
    merge(other, pose_of(options.placement), map);
  } catch (const Error& error) {
    throw Error(fmt::format("{} into {}: {}", options.second, options.first, error.what()));
  }
  merge_attachments(options, other, map);
  write_voxel_map(options.output, map);
  std::cout << fmt::format("{}: {} voxels of {} m\n", options.output, map.known_voxel_count(),
                           map.voxel_size_m());
  return ExitCode::ok;
}

}  // namespace

void add_merge(CLI::App& program, Action& action) {
  auto options = std::make_shared<MergeOptions>();
  CLI::App* command = program.add_subcommand("merge", "two voxel maps as one");
  command->add_option("FIRST", options->first, "map.svx whose frame is kept")->required();
  command->add_option("SECOND", options->second, "map.svx that is moved and added")->required();
  command->add_option("-o,--output", options->output, "the merged map")
      ->required()
      ->type_name("FILE.svx");
  command
      ->add_option("--at", options->placement,
                   "where the second map's origin lies in the first, in metres and degrees")
      ->type_name("X,Y,Z,YAW")
      ->delimiter(',')
      ->expected(4);
  command->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace stereovox
