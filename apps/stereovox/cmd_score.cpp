// stereovox score trajectory|disparity TRUTH ESTIMATE: how right. Maps: cmd_score_map.cpp.
#include <algorithm>
#include <fstream>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "cmd_score_map.h"
#include "command.h"
#include "stereovox/evaluation/score_report.h"
#include "stereovox/io/atomic_file.h"
#include "stereovox/io/disparity_file.h"
#include "stereovox/io/image_file.h"
#include "stereovox/io/trajectory_file.h"

namespace stereovox {
namespace {

struct ScoreOptions {
  std::string truth, estimate, json;
};

struct TrajectoryOptions : ScoreOptions {
  std::vector<std::string> settings;
  std::vector<double> segment_lengths_m;
};

struct DisparityScoreOptions : ScoreOptions {
  std::string mask;
  bool without_occlusions = false;
};

template <class Score>
ExitCode show(const Score& score, const std::string& json_path) {
  std::cout << to_text(score);
  if (!json_path.empty())
    write_file_atomically(json_path,
                          [&](std::ostream& out) { out << to_json(score).dump(2) << "\n"; });
  return ExitCode::ok;
}

std::vector<std::int64_t> stamps_of(const Trajectory& trajectory) {
  std::vector<std::int64_t> stamps_ns;
  for (const StampedPose& pose : trajectory) stamps_ns.push_back(pose.stamp_ns);
  return stamps_ns;
}

std::vector<std::int64_t> whole_seconds(std::size_t count) {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  std::vector<std::int64_t> stamps_ns;
  for (std::size_t i = 0; i < count; ++i)
    stamps_ns.push_back(static_cast<std::int64_t>(i) * kSecond_ns);
  return stamps_ns;
}

// Poses without times have those of `other`, or of frames that are counted when it has none either.
Trajectory read_beside(const std::string& path, const std::string& other) {
  if (!holds_kitti_poses(path)) return read_tum(path);
  return read_poses(path, holds_kitti_poses(other) ? whole_seconds(read_kitti_poses(path).size())
                                                   : stamps_of(read_tum(other)));
}

ExitCode score(const TrajectoryOptions& options) {
  require_output(options.json, {options.truth, options.estimate});
  TrajectoryScoreParams params;
  apply_settings(parse_settings(options.settings), params);
  params.segment_lengths_m = options.segment_lengths_m;
  return show(score_trajectory(read_beside(options.truth, options.estimate),
                               read_beside(options.estimate, options.truth), params),
              options.json);
}

ExitCode score(const DisparityScoreOptions& options) {
  require_output(options.json, {options.truth, options.estimate, options.mask});
  const DisparityImage truth = read_disparity(options.truth);
  cv::Mat1b counted;
  if (!options.mask.empty()) counted = read_gray_image(options.mask).image.pixels == 255;
  if (options.without_occlusions) counted = non_occluded(truth);
  return show(score_disparity(truth, read_disparity(options.estimate), counted), options.json);
}

template <class Options>
std::shared_ptr<Options> add_kind(CLI::App& score_command, const char* name, const char* what,
                                  Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* command = score_command.add_subcommand(name, what);
  command->add_option("TRUTH", options->truth)->required();
  command->add_option("ESTIMATE", options->estimate)->required();
  command->add_option("--json", options->json, "write the score to this file, too")
      ->type_name("FILE");
  command->callback([options, &action] { action = [options] { return score(*options); }; });
  return options;
}

}  // namespace

void add_score(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("score", "compare a result with the truth");
  command->require_subcommand(1);
  const auto trajectory = add_kind<TrajectoryOptions>(
      *command, "trajectory", "two TUM files: ATE, RPE (as evo), KITTI t_rel and r_rel", action);
  command->get_subcommand("trajectory")
      ->add_option("--set", trajectory->settings, "for example alignment=origin, rpe_delta=5")
      ->type_name("FIELD=VALUE")
      ->allow_extra_args(false);
  command->get_subcommand("trajectory")
      ->add_option("--lengths", trajectory->segment_lengths_m,
                   "segments of KITTI's drift, in metres")
      ->delimiter(',')
      ->type_name("M,M,...");
  const auto disparity = add_kind<DisparityScoreOptions>(
      *command, "disparity", "two PFM or KITTI PNG files: bad-N, D1, MAE, density", action);
  CLI::Option* const mask =
      command->get_subcommand("disparity")
          ->add_option("--mask", disparity->mask, "image, white where pixels count")
          ->type_name("FILE");
  command->get_subcommand("disparity")
      ->add_flag("--without-occlusions", disparity->without_occlusions,
                 "count what the true disparities show to both cameras only")
      ->excludes(mask);
  add_score_map(*command, action);
  add_score_voxels(*command, action);
}

}  // namespace stereovox
