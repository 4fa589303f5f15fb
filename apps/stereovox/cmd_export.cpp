// stereovox export MAP.svx -o F.{bt,ot,ply,pcd,vdb}: a voxel map in the form of another program.
#include <fmt/format.h>

#include <iostream>
#include <memory>

#include "command.h"
#include "stereovox/occupancy/export_octomap.h"
#include "stereovox/occupancy/export_openvdb.h"
#include "stereovox/occupancy/export_points.h"
#include "stereovox/occupancy/voxel_map_file.h"

namespace stereovox {
namespace {

namespace fs = std::filesystem;

struct ExportOptions {
  std::string map, output;
  bool is_all_known = false;
  QueryParams query;
};

void write(const ExportOptions& options, const VoxelMap& map) {
  const fs::path output = options.output;
  if (output.extension() == ".bt" || output.extension() == ".ot")
    export_octomap(output, map, options.query);
  else if (output.extension() == ".vdb")
    export_openvdb(output, map, options.query);
  else
    export_points(output, map, options.query,
                  options.is_all_known ? ExportedVoxels::known : ExportedVoxels::occupied);
}

void check_form(const std::string& output) {
  const std::string form = fs::path(output).extension();
  if (form != ".bt" && form != ".ot" && form != ".ply" && form != ".pcd" && form != ".vdb")
    throw UsageError(output + ": no known form; a file ends in .bt, .ot, .ply, .pcd or .vdb");
  if (form == ".vdb") require_openvdb(output);
}

ExitCode run(const ExportOptions& options) {
  check_form(options.output);
  require_output(options.output, {options.map});
  write(options, read_voxel_map(options.map));
  std::cout << fmt::format("{}: {} bytes\n", options.output, fs::file_size(options.output));
  return ExitCode::ok;
}

}  // namespace

void add_export(CLI::App& program, Action& action) {
  auto options = std::make_shared<ExportOptions>();
  CLI::App* command = program.add_subcommand(
      "export", "a voxel map for OctoMap (.bt, .ot), as points or for OpenVDB (.vdb)");
  command->add_option("MAP", options->map, "map.svx of a run")->required();
  command->add_option("-o,--output", options->output, "the ending chooses the form")
      ->required()
      ->type_name("FILE.{bt,ot,ply,pcd,vdb}");
  command->add_option("--threshold", options->query.threshold, "occupied above it")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command
      ->add_option("--min-observations", options->query.min_observations,
                   "voxels observed less often are left out")
      ->check(CLI::Range(1, 65535))
      ->capture_default_str();
  command->add_flag("--all", options->is_all_known, "points for the free voxels, too");
  command->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace stereovox
