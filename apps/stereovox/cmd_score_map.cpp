// stereovox score map IDEAL.yaml MAP.yaml, score voxels REF.svx MAP.svx: how right a map is.
#include "cmd_score_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "stereovox/evaluation/draw_score.h"
#include "stereovox/evaluation/map_score_report.h"
#include "stereovox/evaluation/value_grid.h"
#include "stereovox/evaluation/voxel_score.h"
#include "stereovox/io/atomic_file.h"
#include "stereovox/io/image_file.h"
#include "stereovox/navmap/read_map_server.h"
#include "stereovox/occupancy/voxel_map_file.h"

namespace stereovox {
namespace {

constexpr double kMaxAlignment_m = 2.0;  // farther off, a map is not shifted but of another place

struct MapOptions {
  std::string ideal, map, doorways, json, csv, plot;
  std::vector<double> start_m;
  bool resample = false, align = false;
  std::optional<double> robot_radius_m;
  std::vector<std::string> settings;
};

struct VoxelOptions {
  std::string ideal, map, json;
  std::vector<std::string> settings;
};

void write_text(const std::string& path, const std::string& text) {
  if (path.empty()) return;
  write_file_atomically(path, [&](std::ostream& out) { out << text; });
}

MapScoreParams params_of(const MapOptions& options) {
  Settings settings;
  if (options.robot_radius_m)
    settings.emplace_back("robot_radius_m", fmt::format("{}", *options.robot_radius_m));
  for (const auto& setting : parse_settings(options.settings)) settings.push_back(setting);
  MapScoreParams params;
  apply_settings(settings, params);
  return params;
}

IdealMap read_ideal(const MapOptions& options) {
  std::optional<Eigen::Vector2d> start_m;
  if (!options.start_m.empty()) start_m = {options.start_m[0], options.start_m[1]};
  return make_ideal(read_map_server(options.ideal).grid, start_m);
}

// The map to be scored, brought to the ideal one as far as the options ask for it.
OccupancyGrid2D read_compared(const MapOptions& options, const IdealMap& ideal) {
  OccupancyGrid2D map = read_map_server(options.map).grid;
  const GridGeometry& lattice = ideal.theoretical.geometry;
  if (options.resample)
    map = resampled_to(map, lattice);
  else if (!have_same_cell_size(map.geometry, lattice))
    throw Error(
        fmt::format("{}: its cells are {:.9g} m wide, those of {} {:.9g} m; --resample "
                    "brings it to those",
                    options.map, map.geometry.cell_size_m, options.ideal, lattice.cell_size_m));
  if (!options.align) return map;
  const AlignedMap aligned = aligned_to(ideal, map, kMaxAlignment_m);
  std::cout << fmt::format("aligned: moved by ({:g}, {:g}) m\n", aligned.shift_m.x(),
                           aligned.shift_m.y());
  return aligned.map;
}

ExitCode score(const MapOptions& options) {
  const MapScoreParams params = params_of(options);
  for (const std::string& output : {options.json, options.csv, options.plot})
    require_output(output, {options.ideal, options.map});
  MapScoreInput input;
  if (!options.doorways.empty()) input.doorways = read_doorways(options.doorways);
  const IdealMap ideal = read_ideal(options);
  const OccupancyGrid2D map = read_compared(options, ideal);
  const int threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  const MapScore result = score_map(ideal, map, params, input, threads);

  std::cout << to_text(result);
  write_text(options.json, to_json(result).dump(2) + "\n");
  write_text(options.csv, csv_header() + csv_row(result));
  if (!options.plot.empty()) write_png(options.plot, draw_score(ideal, map));
  return ExitCode::ok;
}

ExitCode score(const VoxelOptions& options) {
  VoxelScoreParams params;
  apply_settings(parse_settings(options.settings), params);
  require_output(options.json, {options.ideal, options.map});
  const VoxelScore result =
      score_voxels(read_voxel_map(options.ideal), read_voxel_map(options.map), params);
  std::cout << to_text(result);
  write_text(options.json, to_json(result).dump(2) + "\n");
  return ExitCode::ok;
}

template <class Options>
CLI::App* add_kind(CLI::App& score_command, const char* name, const char* what,
                   const std::shared_ptr<Options>& options, Action& action) {
  CLI::App* command = score_command.add_subcommand(name, what);
  command->add_option("IDEAL", options->ideal, "the true map")->required();
  command->add_option("MAP", options->map, "the map to be scored")->required();
  command->add_option("--json", options->json, "write the score to this file, too")
      ->type_name("FILE");
  command->add_option("--set", options->settings, "a parameter, for example min_observations=2")
      ->type_name("FIELD=VALUE")
      ->allow_extra_args(false);
  command->callback([options, &action] { action = [options] { return score(*options); }; });
  return command;
}

}  // namespace

void add_score_map(CLI::App& score_command, Action& action) {
  auto options = std::make_shared<MapOptions>();
  CLI::App* command =
      add_kind(score_command, "map", "two map_server maps: the map benchmark", options, action);
  command->get_option("--set")->description("for example waypoint_pitch_m=0.5");
  command->add_option("--start", options->start_m, "free space of the ideal map begins here")
      ->delimiter(',')
      ->expected(2)
      ->type_name("X,Y");
  command->add_flag("--resample", options->resample, "bring the map to the ideal map's cells");
  command->add_flag("--align", options->align, "move the map by whole cells to where it fits best");
  command->add_option("--doorways", options->doorways, "test these doorways (YAML)")
      ->type_name("FILE");
  command->add_option("--robot-radius", options->robot_radius_m, "for paths and doors")
      ->type_name("METRES");
  command->add_option("--csv", options->csv, "write names and values, for tables")
      ->type_name("FILE");
  command->add_option("--plot", options->plot, "draw hits, misses and inventions (PNG)")
      ->type_name("FILE");
}

void add_score_voxels(CLI::App& score_command, Action& action) {
  add_kind(score_command, "voxels", "two map.svx files: precision, recall, distances",
           std::make_shared<VoxelOptions>(), action);
}

}  // namespace stereovox
