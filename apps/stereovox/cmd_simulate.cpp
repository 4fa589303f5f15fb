// stereovox simulate WORLD.yaml -o DATASET: a drive through a described world, with its truth.
#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <iostream>
#include <memory>
#include <numbers>

#include "command.h"
#include "interrupt.h"
#include "simulated_source.h"
#include "stereovox/experiment/ideal_maps.h"
#include "stereovox/navmap/write_map_server.h"
#include "stereovox/occupancy/voxel_map_file.h"
#include "stereovox/simulation/world_file.h"
#include "stereovox/simulation/write_data_set.h"

namespace stereovox {
namespace {

namespace fs = std::filesystem;

struct SimulateOptions {
  std::string world, drive, output;
  std::optional<int> seed;
  std::vector<std::string> settings;
  std::vector<double> cell_sizes_m = {0.25, 0.1, 0.05};
  double voxel_size_m = 0.0;
  int threads = 0, truth_every = 1;
  bool overwrite = false, quiet = false;
};

SimulationParams params_of(const SimulateOptions& options) {
  SimulationParams params;
  if (options.seed) apply_settings({{"seed", std::to_string(*options.seed)}}, params);
  apply_settings(parse_settings(options.settings), params);
  return params;
}

// On a terminal one line that changes, in a log a line from time to time.
void show_progress(int done, int frames) {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::seconds kLogPeriod{10};
  static Clock::time_point last_shown = Clock::now();
  const bool is_terminal = isatty(STDOUT_FILENO) == 1, is_last = done == frames;
  if (!is_terminal && !is_last && Clock::now() - last_shown < kLogPeriod) return;
  last_shown = Clock::now();
  std::cout << fmt::format("{}frame {}/{}{}", is_terminal ? "\r" : "", done, frames,
                           is_terminal && !is_last ? "" : "\n")
            << std::flush;
}

void write_ideal_maps(const SimulateOptions& options, const Simulation& simulation) {
  const Eigen::Vector2d start_m =
      simulation.trajectory().front().T_world_camera.translation.head<2>();
  for (const double cell_size_m : options.cell_sizes_m) {
    const IdealMap ideal = ideal_map(simulation.world(), cell_size_m, HeightBand{}, start_m);
    write_map_server(fs::path(options.output) / ideal_map_name(cell_size_m), planning_map(ideal),
                     MapServerMode::trinary);
  }
  write_doorways(fs::path(options.output) / "doorways.yaml", doorways_of(simulation.world()));
  if (options.voxel_size_m > 0)
    write_voxel_map(fs::path(options.output) / "ideal_voxels.svx",
                    ideal_voxel_map(simulation.world(), options.voxel_size_m));
}

// So that a map of estimated poses can be laid over the ideal one.
void print_start(const std::string& output, const SE3& T_world_camera) {
  const Eigen::Vector3d forward = T_world_camera.rotation * Eigen::Vector3d::UnitZ();
  std::cout << fmt::format(
      "in the world of the ideal maps: stereovox run {} -o OUT --start-pose {:.4f},{:.4f},{:.3f}\n",
      output, T_world_camera.translation.x(), T_world_camera.translation.y(),
      std::atan2(forward.y(), forward.x()) * 180 / std::numbers::pi);
}

// Frames of an earlier data set must not stay among those of a new one.
void prepare_data_set_folder(const fs::path& folder, bool overwrite) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    throw ResourceError(fmt::format("{}: cannot be made ({})", folder.string(), error.message()));
  for (const char* name :
       {"left", "right", "truth", "mav0", "calib.yaml", "times.txt", "poses.txt"}) {
    if (!fs::exists(folder / name)) continue;
    if (!overwrite)
      throw UsageError(folder.string() + ": holds a data set; give --overwrite to replace it");
    fs::remove_all(folder / name, error);
    if (error)
      throw ResourceError(
          fmt::format("{}: cannot be replaced ({})", (folder / name).string(), error.message()));
  }
}

ExitCode run(const SimulateOptions& options) {
  World world = read_world(options.world);
  const std::string drive = options.drive.empty() ? default_drive(world) : options.drive;
  PipelineConfig threads;
  threads.threads = options.threads;
  const Simulation simulation(std::move(world), drive, params_of(options), options.world,
                              threads.thread_count());
  prepare_data_set_folder(options.output, options.overwrite);
  catch_interrupt();
  write_ideal_maps(options, simulation);
  DataSetOptions how{.truth_every = options.truth_every, .should_stop = was_interrupted};
  if (!options.quiet) how.progress = show_progress;
  const int frames = write_data_set(options.output, simulation, how);
  if (!options.quiet)
    std::cout << fmt::format("{}: {} pairs of drive '{}', {:.1f} m\n", options.output, frames,
                             drive, path_length_m(simulation.trajectory()));
  if (!options.quiet) print_start(options.output, simulation.trajectory().front().T_world_camera);
  return was_interrupted() ? ExitCode::interrupted : ExitCode::ok;
}

}  // namespace

void add_simulate(CLI::App& program, Action& action) {
  auto options = std::make_shared<SimulateOptions>();
  CLI::App* command =
      program.add_subcommand("simulate", "render a drive through a described world, with truth");
  command->add_option("WORLD", options->world, "YAML file of a world; see docs/simulation.md")
      ->required();
  command->add_option("-o,--output", options->output, "folder for the data set")->required();
  command->add_option("--drive", options->drive, "name of the drive, default main");
  command->add_option("--seed", options->seed, "of noise, shaking and jitter")->type_name("N");
  command->add_option("--set", options->settings, "one parameter; may be given again")
      ->type_name("FIELD=VALUE")
      ->allow_extra_args(false);
  command->add_option("--cell-size", options->cell_sizes_m, "of the ideal maps")
      ->type_name("METRES")
      ->check(CLI::Range(0.01, 10.0));
  command->add_option("--voxel-size", options->voxel_size_m, "of ideal voxels, none by default")
      ->type_name("METRES")
      ->check(CLI::Range(0.01, 10.0));
  command
      ->add_option("--truth-every", options->truth_every,
                   "depth, disparity and hidden pixels of every N-th frame, 0 = of none")
      ->type_name("N")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--threads", options->threads, "0 = one for each core")->type_name("N");
  command->add_flag("--overwrite", options->overwrite, "replace an earlier data set");
  command->add_flag("-q,--quiet", options->quiet, "print warnings and errors only");
  command->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace stereovox
