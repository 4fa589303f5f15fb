#include "command.h"

#include <fmt/format.h>

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <iostream>

#include "simulated_source.h"
#include "stereovox/dataset/read_ahead.h"

namespace stereovox {
namespace {

namespace fs = std::filesystem;

template <class Value>
void add_if_given(Settings& settings, const char* path, const std::optional<Value>& value) {
  if (value) settings.emplace_back(path, fmt::format("{}", *value));
}

}  // namespace

void ConfigOptions::add_to(CLI::App& command) {
  command.add_option("--config", file, "YAML file of parameters")->type_name("FILE");
  command.add_option("--set", settings, "one parameter; may be given again")
      ->type_name("SECTION.FIELD=VALUE")
      ->allow_extra_args(false);
}

PipelineConfig ConfigOptions::load(const Settings& shorthands) const {
  PipelineConfig config;
  if (!file.empty()) apply_settings(read_settings(file), config);
  apply_settings(shorthands, config);
  apply_settings(parse_settings(settings), config);
  return config;
}

void SourceOptions::add_to(CLI::App& command) {
  command
      .add_option("SOURCE", source,
                  "folder of a data set (plain, KITTI odometry or EuRoC/ASL), or "
                  "sim:WORLD.yaml[:DRIVE[:SEED]]")
      ->required();
  command
      .add_option("--calib", calibration,
                  "calibration to use instead of the data set's: plain, Kalibr, ROS, OpenCV, "
                  "KITTI or EuRoC/ASL, a file or its folder")
      ->type_name("FILE");
  command.add_option("--start", start_s, "skip this much")->type_name("SECONDS");
  command.add_option("--duration", duration_s, "use only this much")->type_name("SECONDS");
  command.add_option("--max-frames", max_frames, "use at most this many frames")->type_name("N");
  command.add_option("--frame-skip", frame_skip, "after each frame leave out N")->type_name("N");
  command.add_option("--threads", threads, "0 = one for each core")->type_name("N");
}

Settings SourceOptions::shorthands() const {
  Settings settings;
  add_if_given(settings, "dataset.start_s", start_s);
  add_if_given(settings, "dataset.duration_s", duration_s);
  add_if_given(settings, "dataset.max_frames", max_frames);
  add_if_given(settings, "dataset.frame_skip", frame_skip);
  add_if_given(settings, "threads", threads);
  return settings;
}

std::unique_ptr<StereoSequence> SourceOptions::open(const PipelineConfig& config) const {
  constexpr int kFramesAhead = 4;
  std::optional<std::filesystem::path> override_path;
  if (!calibration.empty()) override_path = calibration;
  if (is_simulated_source(source))
    return open_simulated_source(source, config.dataset, config.thread_count());
  auto sequence = open_sequence(source, config.dataset, override_path);
  return config.thread_count() > 1 ? read_ahead(std::move(sequence), kFramesAhead)
                                   : std::move(sequence);
}

void require_output(const fs::path& file, const std::vector<fs::path>& inputs) {
  if (file.empty()) return;
  const fs::path folder = fs::absolute(file).parent_path();
  if (!fs::is_directory(folder))
    throw ResourceError(file.string() + ": cannot be written, there is no folder " +
                        folder.string());
  if (fs::is_directory(file)) throw ResourceError(file.string() + ": is a folder, not a file");
  if (access(folder.c_str(), W_OK) != 0)
    throw ResourceError(
        fmt::format("{}: cannot be written ({})", file.string(), std::strerror(errno)));
  for (const fs::path& input : inputs)
    if (fs::exists(file) && fs::exists(input) && fs::equivalent(file, input))
      throw UsageError(file.string() + ": is read by this command, it cannot be its output, too");
}

void warn(const std::string& text) { std::cerr << "stereovox: warning: " << text << "\n"; }

}  // namespace stereovox
