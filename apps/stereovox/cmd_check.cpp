// stereovox check SOURCE|CALIB|MAP: what it is and what is wrong with it, in one screen.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <opencv2/core.hpp>

#include "command.h"
#include "stereovox/dataset/calibration_file.h"
#include "stereovox/io/file_kind.h"
#include "stereovox/io/yaml_file.h"
#include "stereovox/navmap/read_map_server.h"
#include "stereovox/occupancy/voxel_map_file.h"
#include "stereovox/pipeline/report.h"
#include "stereovox/stereo/rectification_check.h"

namespace stereovox {
namespace {

namespace fs = std::filesystem;

// Enough frames to tell, spread over the sequence.
constexpr int kSampledPairs = 10;

struct CheckOptions {
  std::string what, calibration, salvage;
};

void print_rig(const StereoRig& rig) {
  const PinholeCamera& c = rig.left.pinhole;
  std::cout << fmt::format(
      "calibration ok: {} x {}, fx {:.3f} px, baseline {:.4f} m, horizontal field of view {:.0f} "
      "deg, {}\n",
      c.width, c.height, c.fx_px, rig.baseline_m(),
      2.0 * std::atan(0.5 * c.width / c.fx_px) * 180.0 / M_PI,
      rig.is_rectified ? "images are said to be rectified" : "images will be rectified");
  for (const std::string& oddity : oddities(rig)) warn(oddity);
}

SequenceParams sparse(int pairs) {
  SequenceParams params;
  params.frame_skip = std::max(0, pairs / kSampledPairs - 1);
  params.max_frames = kSampledPairs;
  return params;
}

struct Samples {
  std::vector<CornerOffsets> offsets;
  double density_percent = 0.0, brightness = 0.0;
  int pairs = 0;
};

Samples sample(StereoSequence& sequence) {
  const Rectifier rectifier(sequence.rig(), {});
  Samples samples;
  while (const std::optional<StereoFrame> frame = sequence.next()) {
    const RectifiedPair pair = rectifier.rectify(*frame);
    samples.offsets.push_back(measure_corner_offsets(pair));
    const DisparityImage disparity = match(pair, MatcherParams{});
    samples.density_percent += 100.0 * cv::countNonZero(disparity.disparity_px) /
                               static_cast<double>(disparity.disparity_px.total());
    samples.brightness += cv::mean(pair.left.pixels)[0];
    ++samples.pairs;
  }
  samples.density_percent /= std::max(1, samples.pairs);
  samples.brightness /= std::max(1, samples.pairs);
  return samples;
}

ExitCode check_source(const fs::path& path, const std::optional<fs::path>& calibration) {
  const auto whole = open_sequence(path, SequenceParams{}, calibration);
  const SequenceInfo& info = whole->info();
  std::cout << fmt::format(
      "{}: {}, {} pairs, {} left only, {} right only, {} duplicates, {} gaps\n", path.string(),
      info.layout, info.pairs, info.left_only, info.right_only, info.duplicates, info.gaps);
  for (const std::string& remark : info.remarks) warn(remark);
  print_rig(whole->rig());

  const auto sparse_sequence = open_sequence(path, sparse(info.pairs), calibration);
  const Samples samples = sample(*sparse_sequence);
  const RectificationCheck rectification = summarize(samples.offsets);
  std::cout << fmt::format(
      "{} sampled pairs: vertical offset {:.2f} px (median of {} corners), {:.0f} % of the pixels "
      "have a disparity, mean brightness {:.0f} of 255\n",
      samples.pairs, rectification.vertical_px, rectification.corners, samples.density_percent,
      samples.brightness);
  for (const SkippedPair& pair : sparse_sequence->skipped()) warn(pair.name + ": " + pair.reason);
  const std::string warning = judge(rectification, RectificationParams{}, path.string());
  if (!warning.empty()) warn(warning);
  return ExitCode::ok;
}

ExitCode check_voxel_map(const fs::path& path) {
  const VoxelMap map = read_voxel_map(path);
  std::cout << fmt::format("{}: intact, {} voxels of {} m observed in {} frames\n", path.string(),
                           map.known_voxel_count(), map.voxel_size_m(), map.frames_integrated);
  return ExitCode::ok;
}

// Writes what is intact of a damaged map to a new file.
ExitCode salvage(const fs::path& path, const fs::path& output) {
  require_output(output);
  const SalvagedMap salvaged = salvage_voxel_map(path);
  for (const std::string& loss : salvaged.losses) warn(path.string() + ": " + loss);
  write_voxel_map(output, salvaged.map);
  std::cout << fmt::format("{}: {} voxels kept, {}\n", output.string(),
                           salvaged.map.known_voxel_count(),
                           salvaged.losses.empty() ? "nothing lost" : "see the warnings");
  return ExitCode::ok;
}

ExitCode check_navigation_map(const fs::path& path) {
  const LoadedMap loaded = read_map_server(path);
  const auto count = [&](CellLabel label) { return std::ranges::count(loaded.grid.labels, label); };
  std::cout << fmt::format("{}: {} x {} cells of {} m: {} occupied, {} free, {} unknown\n",
                           path.string(), loaded.grid.geometry.width, loaded.grid.geometry.height,
                           loaded.grid.geometry.cell_size_m, count(CellLabel::occupied),
                           count(CellLabel::free), count(CellLabel::unknown));
  std::cout << loaded.convention << "\n";
  for (const std::string& remark : loaded.remarks) warn(remark);
  return ExitCode::ok;
}

ExitCode check_calibration(const fs::path& path) {
  const StereoRig rig = read_calibration(path, [&]() -> cv::Size {
    throw Error(path.string() +
                ": does not say how large the images are; check it with them: "
                "stereovox check SOURCE --calib FILE");
  });
  validate(rig, path.string());
  print_rig(rig);
  return ExitCode::ok;
}

bool is_navigation_map(const fs::path& path) {
  if (path.extension() != ".yaml") return false;
  const YAML::Node root = load_yaml(path);
  return root.IsMap() && root["image"].IsDefined();
}

ExitCode run(const CheckOptions& options) {
  const fs::path path = options.what;
  if (!options.salvage.empty()) return salvage(path, options.salvage);
  if (path.extension() == ".svx") return check_voxel_map(path);
  if (fs::is_directory(path)) {
    std::optional<fs::path> calibration;
    if (!options.calibration.empty()) calibration = options.calibration;
    return check_source(path, calibration);
  }
  if (const std::string kind = kind_of_file(path); !kind.empty())
    throw Error(fmt::format("{}: is {}, a data set, a calibration or a map is needed",
                            path.string(), kind));
  if (is_navigation_map(path)) return check_navigation_map(path);
  return check_calibration(path);
}

}  // namespace

void add_check(CLI::App& program, Action& action) {
  auto options = std::make_shared<CheckOptions>();
  CLI::App* command = program.add_subcommand(
      "check", "what a data set, a calibration or a map is, and what is wrong");
  command->add_option("WHAT", options->what, "data set, calibration, map.svx or nav.yaml")
      ->required();
  command->add_option("--calib", options->calibration, "calibration to use with the data set")
      ->type_name("FILE");
  command
      ->add_option("--salvage", options->salvage,
                   "write what is intact of a damaged map.svx to this file")
      ->type_name("FILE.svx");
  command->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace stereovox
