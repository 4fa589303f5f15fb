// stereovox navmap MAP.svx -o nav.yaml: the 2D map of a voxel map, with other parameters if wished.
#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <memory>

#include "command.h"
#include "stereovox/navmap/project_to_2d.h"
#include "stereovox/occupancy/voxel_map_file.h"
#include "stereovox/pipeline/outputs.h"

namespace stereovox {
namespace {

struct NavmapOptions {
  std::string map, output, mode = "trinary";
  ConfigOptions config;
  std::optional<double> min_z_m, max_z_m;
  std::optional<int> min_observations;
};

Settings shorthands(const NavmapOptions& options) {
  Settings settings;
  if (options.min_z_m)
    settings.emplace_back("navmap.min_height_m", fmt::format("{}", *options.min_z_m));
  if (options.max_z_m)
    settings.emplace_back("navmap.max_height_m", fmt::format("{}", *options.max_z_m));
  if (options.min_observations)
    settings.emplace_back("navmap.min_observations", fmt::format("{}", *options.min_observations));
  return settings;
}

MapServerMode mode_of(const std::string& name) {
  return name == "scale" ? MapServerMode::scale
         : name == "raw" ? MapServerMode::raw
                         : MapServerMode::trinary;
}

void print_counts(const std::string& output, const OccupancyGrid2D& grid) {
  const auto count = [&](CellLabel label) { return std::ranges::count(grid.labels, label); };
  std::cout << fmt::format("{}: {} x {} cells of {} m: {} occupied, {} free, {} unknown\n", output,
                           grid.geometry.width, grid.geometry.height, grid.geometry.cell_size_m,
                           count(CellLabel::occupied), count(CellLabel::free),
                           count(CellLabel::unknown));
  std::cout << "ros2 run nav2_map_server map_server --ros-args -p yaml_filename:=" << output
            << "\n";
}

// The image and the picture go beside it under the same name, so it must not be theirs.
std::string yaml_name(const std::string& output) {
  const std::string ending = std::filesystem::path(output).extension();
  if (ending.empty()) return output + ".yaml";
  if (ending == ".yaml" || ending == ".yml") return output;
  throw UsageError(output + ": the name of a navigation map ends in .yaml");
}

// Of the run that made the map, or the defaults.
NavmapParams navmap_params_of(const VoxelMap& map, const std::string& source) {
  PipelineConfig config;
  if (const auto text = map.attachments.find("config.yaml"); text != map.attachments.end())
    apply_settings(settings_of(text->second, source + ", config.yaml"), config);
  return config.navmap;
}

bool have_same_band(const NavmapParams& a, const NavmapParams& b) {
  return a.column == b.column && a.min_height_m == b.min_height_m &&
         a.max_height_m == b.max_height_m;
}

SightLines sight_lines_for(const NavmapParams& params, const VoxelMap& map,
                           const std::string& source) {
  SightLines sight_lines = attached_sight_lines(map, source);
  if (!have_same_band(params, navmap_params_of(map, source))) sight_lines.keep_seen(map, params);
  return sight_lines;
}

void warn_of_nothing(const OccupancyGrid2D& grid, const NavmapParams& params) {
  const auto is_unknown = [](CellLabel label) { return label == CellLabel::unknown; };
  if (!std::ranges::all_of(grid.labels, is_unknown)) return;
  warn(
      params.column == ColumnRule::whole
          ? std::string("nothing of the map was seen often enough: every cell is unknown")
          : fmt::format("nothing was seen often enough from {} to {} m above the floor: every cell "
                        "is unknown",
                        params.min_height_m, params.max_height_m));
}

ExitCode run(const NavmapOptions& options) {
  const std::string output = yaml_name(options.output);
  require_output(output, {options.map});
  const PipelineConfig config = options.config.load(shorthands(options));
  const VoxelMap map = read_voxel_map(options.map);
  const OccupancyGrid2D grid = write_navigation_map(
      output, map, sight_lines_for(config.navmap, map, options.map),
      attached_wall_faces(map, options.map), {}, config.navmap, mode_of(options.mode));
  print_counts(output, grid);
  warn_of_nothing(grid, config.navmap);
  return ExitCode::ok;
}

}  // namespace

void add_navmap(CLI::App& program, Action& action) {
  auto options = std::make_shared<NavmapOptions>();
  CLI::App* command = program.add_subcommand("navmap", "2D navigation map of a voxel map");
  command->add_option("MAP", options->map, "map.svx of a run")->required();
  options->config.add_to(*command);
  command->add_option("-o,--output", options->output, "nav.yaml; the image goes beside it")
      ->required()
      ->type_name("FILE");
  command->add_option("--mode", options->mode, "how the image is to be read")
      ->check(CLI::IsMember({"trinary", "scale", "raw"}))
      ->capture_default_str();
  command->add_option("--min-z", options->min_z_m, "lowest obstacle above the floor")
      ->type_name("METRES");
  command->add_option("--max-z", options->max_z_m, "highest obstacle above the floor")
      ->type_name("METRES");
  command->add_option("--min-observations", options->min_observations, "of a voxel that counts")
      ->type_name("N");
  command->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace stereovox
