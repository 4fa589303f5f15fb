// stereovox run SOURCE -o OUT: images in, maps out.
#include <fmt/format.h>

#include <iostream>
#include <memory>
#include <opencv2/core/utility.hpp>

#include "command.h"
#include "interrupt.h"
#include "run_display.h"
#include "stereovox/core/timestamp.h"
#include "stereovox/dataset/stamps.h"
#include "stereovox/io/trajectory_file.h"
#include "stereovox/occupancy/frame_view.h"
#include "stereovox/pipeline/build_maps.h"
#include "stereovox/pipeline/output_folder.h"
#include "stereovox/pipeline/outputs.h"
#include "stereovox/pipeline/report.h"

namespace stereovox {
namespace {

struct RunOptions {
  SourceOptions source;
  ConfigOptions config;
  std::string output, poses, preset;
  std::optional<double> camera_height_m, camera_pitch_deg;
  std::vector<double> start_pose;
  std::optional<std::uint64_t> memory_limit_bytes;
  bool overwrite = false, quiet = false, verbose = false, json_progress = false;
};

Settings shorthands(const RunOptions& options) {
  Settings settings = options.source.shorthands();
  if (!options.preset.empty())
    for (const auto& setting : preset_settings(options.preset)) settings.push_back(setting);
  const auto set = [&](const char* path, const std::optional<double>& value) {
    if (!value) return;
    settings.emplace_back("world.level", "given");
    settings.emplace_back(path, fmt::format("{}", *value));
  };
  set("world.camera_height_m", options.camera_height_m);
  set("world.camera_pitch_deg", options.camera_pitch_deg);
  constexpr double kBytesPerMb = 1e6;
  if (options.memory_limit_bytes)
    settings.emplace_back(
        "memory_limit_mb",
        fmt::format("{}", static_cast<double>(*options.memory_limit_bytes) / kBytesPerMb));
  constexpr const char* kStart[] = {"world.start_x_m", "world.start_y_m", "world.start_yaw_deg"};
  for (std::size_t i = 0; i < options.start_pose.size(); ++i)
    settings.emplace_back(kStart[i], fmt::format("{}", options.start_pose[i]));
  return settings;
}

std::vector<std::int64_t> stamps_of(const StereoSequence& sequence, const std::string& poses) {
  const std::filesystem::path times = sequence.info().path / "times.txt";
  if (!std::filesystem::exists(times))
    throw Error(poses + ": has no times, and there is no " + times.string());
  std::vector<std::string> ignored;
  return read_times(times, 0, SequenceParams{}.assumed_rate_hz, ignored);
}

std::optional<Trajectory> given_poses(const std::string& poses, const StereoSequence& sequence) {
  if (poses.empty()) return std::nullopt;
  if (poses != "truth")
    return holds_kitti_poses(poses) ? read_poses(poses, stamps_of(sequence, poses))
                                    : read_tum(poses);
  if (sequence.truth().empty())
    throw Error(sequence.info().path.string() + ": has no true poses; --poses takes a file, too");
  return sequence.truth();
}

DisplayMode display_mode(const RunOptions& options) {
  if (options.json_progress) return DisplayMode::json;
  if (options.quiet) return DisplayMode::quiet;
  return options.verbose ? DisplayMode::verbose : DisplayMode::automatic;
}

// Remarks grow while images are read; `from` counts those that were shown already.
void show_remarks(const StereoSequence& sequence, std::size_t from) {
  const std::vector<std::string>& remarks = sequence.info().remarks;
  for (std::size_t i = from; i < remarks.size(); ++i) warn(remarks[i]);
}

bool holds_images(const std::filesystem::path& folder) {
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::filesystem::path ending = entry.path().extension();
    const bool is_result = entry.path().stem() == "nav";
    if (!is_result && (ending == ".png" || ending == ".jpg" || ending == ".pgm")) return true;
  }
  return false;
}

void print_source(const StereoSequence& sequence) {
  const SequenceInfo& info = sequence.info();
  const PinholeCamera& c = sequence.rig().left.pinhole;
  std::cout << fmt::format("{}: {}, {} pairs of {} x {}, fx {:.2f} px, baseline {:.4f} m, {}\n",
                           info.path.string(), info.layout, info.pairs, c.width, c.height, c.fx_px,
                           sequence.rig().baseline_m(),
                           sequence.rig().is_rectified ? "rectified" : "to be rectified");
}

void print_stages(const StageTimes& times) {
  std::cout << fmt::format("{:<12}{:>12}{:>12}{:>12}\n", "stage", "median ms", "p95 ms", "cpu ms");
  for (const char* stage : kStages) {
    const StageSummary s = times.summary(stage);
    std::cout << fmt::format("{:<12}{:>12.1f}{:>12.1f}{:>12.1f}\n", stage, s.median_ms, s.p95_ms,
                             s.cpu_ms);
  }
}

void print_lost(const BuildResult& result) {
  for (const LostStretch& lost : result.lost)
    std::cout << fmt::format("lost: {:.3f} s to {:.3f} s, {} frames: {}\n",
                             seconds_from_ns(lost.from_ns), seconds_from_ns(lost.to_ns),
                             lost.frames, lost.reason);
  if (result.segments.size() > 1)
    std::cout << fmt::format(
        "{} segments, which share no common frame; further ones are in segment_2 to segment_{}\n",
        result.segments.size(), result.segments.size());
}

void print_summary(const RunOptions& options, const StereoSequence& sequence,
                   const PipelineConfig& config, const BuildResult& result,
                   const std::vector<std::string>& results) {
  const MapSegment& main = result.segments.front();
  const MapCounts counts = count_voxels(main.map, config.navmap.threshold);
  std::cout << main.world.source << "\n";
  print_lost(result);
  std::cout << fmt::format("{}{} of {} frames tracked, {} pairs skipped, {:.1f} s, {:.1f} fps\n",
                           result.was_stopped ? "stopped early: " : "", result.tracked,
                           result.frames, sequence.skipped().size(), result.wall_s,
                           result.frames / std::max(result.wall_s, 1e-9));
  if (result.segments.size() > 1)
    std::cout << fmt::format("the map is that of the longest segment, {} frames\n",
                             main.trajectory.size());
  std::cout << fmt::format("way of {:.2f} m\n", path_length_m(main.trajectory));
  std::cout << fmt::format("{} voxels of {} m: {} occupied, {} free, {:.1f} MB\n", counts.observed,
                           main.map.voxel_size_m(), counts.occupied, counts.free,
                           static_cast<double>(main.map.memory_bytes()) / 1e6);
  const OccupancyParams ranged = with_ranges(config.occupancy, result.camera);
  std::cout << fmt::format(
      "surfaces are marked up to {:.1f} m away, space is cleared up to {:.1f} m\n",
      ranged.max_depth_m, ranged.max_clearing_m);
  print_stages(result.times);
  std::cout << fmt::format("written to {}: {}\n", options.output, fmt::join(results, " "));
}

ProgressSink sink_for(RunDisplay& display) {
  return {[&](const Progress& progress) { display.frame_done(progress); },
          [&](const std::string& text) { display.warn(text); }, was_interrupted};
}

ExitCode exit_code(const PipelineConfig& config, const BuildResult& result,
                   const std::filesystem::path& folder) {
  if (result.was_stopped) return ExitCode::interrupted;
  if (!std::filesystem::exists(folder / "nav.yaml")) return ExitCode::bad_input;
  if (result.tracked_percent() >= config.min_tracked_percent) return ExitCode::ok;
  std::cerr << fmt::format(
      "stereovox: only {:.1f} % of the frames were tracked, less than min_tracked_percent = {}\n",
      result.tracked_percent(), config.min_tracked_percent);
  return ExitCode::below_quality_gate;
}

// Pictures among the images of a data set would be taken for some of them.
void refuse_folder_of_images(const std::filesystem::path& output, const std::string& source) {
  namespace fs = std::filesystem;
  if (!fs::is_directory(output) || !fs::is_directory(source)) return;
  const fs::path inside = fs::relative(output, source);
  if (inside == "." || (*inside.begin() != ".." && holds_images(output)))
    throw UsageError(output.string() + ": is a folder of the data set; results need their own");
}

ExitCode run(const RunOptions& options) {
  const PipelineConfig config = options.config.load(shorthands(options));
  const std::unique_ptr<StereoSequence> sequence = options.source.open(config);
  const std::optional<Trajectory> poses = given_poses(options.poses, *sequence);
  refuse_folder_of_images(options.output, options.source.source);
  OutputFolder folder(options.output, options.overwrite);
  const bool talks = !options.quiet && !options.json_progress;
  if (talks) print_source(*sequence);
  const std::size_t remarks_before = sequence->info().remarks.size();
  show_remarks(*sequence, 0);
  for (const std::string& oddity : oddities(sequence->rig())) warn(oddity);

  // The stages overlap: one core maps while the others match.
  cv::setNumThreads(std::max(1, config.thread_count() - 1));
  catch_interrupt();
  RunDisplay display(display_mode(options));
  BuildResult result = build_maps(*sequence, config, poses, sink_for(display), options.output);
  display.end();
  show_remarks(*sequence, remarks_before);
  for (const SkippedPair& pair : sequence->skipped())
    warn(fmt::format("{}: skipped: {}", pair.name, pair.reason));
  if (!result.failure.empty() && folder.holds_results())
    throw ResourceError(result.failure + "; the earlier results in " + options.output +
                        " are kept");
  const std::size_t warned = result.warnings.size();
  write_outputs(folder.staging(), *sequence, config, result);
  folder.publish();
  for (std::size_t i = warned; i < result.warnings.size(); ++i) warn(result.warnings[i]);
  if (!result.failure.empty())
    throw ResourceError(result.failure + "; what was mapped before is written to " +
                        options.output);
  if (talks) print_summary(options, *sequence, config, result, folder.results());
  return exit_code(config, result, folder.path());
}

}  // namespace

void add_run(CLI::App& program, Action& action) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* command = program.add_subcommand("run", "map a stereo sequence");
  options->source.add_to(*command);
  options->config.add_to(*command);
  command->add_option("-o,--output", options->output, "folder for the results")->required();
  command
      ->add_option("--poses", options->poses,
                   "'truth' of the data set, or a file in TUM's or KITTI's form")
      ->type_name("truth|FILE");
  command
      ->add_option("--preset", options->preset,
                   "the paper as printed, as corrected, or tuned (default)")
      ->check(CLI::IsMember({"literal", "corrected", "tuned"}));
  command->add_option("--camera-height", options->camera_height_m, "of the camera above the floor")
      ->type_name("METRES");
  command->add_option("--camera-pitch", options->camera_pitch_deg, "positive looking down")
      ->type_name("DEGREES");
  command
      ->add_option("--start-pose", options->start_pose,
                   "where the first camera stands and looks, in metres and degrees")
      ->type_name("X,Y,YAW")
      ->delimiter(',')
      ->expected(3);
  command
      ->add_option("--memory-limit", options->memory_limit_bytes,
                   "for voxels; what is out of view waits in a nameless file in the output folder")
      ->type_name("SIZE[M|G]")
      ->transform(CLI::AsSizeValue(true));
  command->add_flag("--overwrite", options->overwrite, "replace the results of an earlier run");
  command->add_flag("-q,--quiet", options->quiet, "print warnings and errors only");
  command->add_flag("-v,--verbose", options->verbose, "print a line for each frame");
  command->add_flag("--json-progress", options->json_progress,
                    "print a JSON object for each frame");
  command->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace stereovox
