// A command of the program: its arguments, and what it does with them.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "stereovox/core/error.h"
#include "stereovox/dataset/open_sequence.h"
#include "stereovox/pipeline/pipeline_config.h"

namespace stereovox {

// What the program ends with (also documented in --help).
enum class ExitCode {
  ok = 0,
  internal = 1,
  usage = 2,
  bad_input = 3,
  below_quality_gate = 4,
  resource = 5,
  interrupted = 130,
};

// Set by the command that was chosen; runs after the whole command line was read.
using Action = std::function<ExitCode()>;

void add_run(CLI::App& program, Action& action);
void add_disparity(CLI::App& program, Action& action);
void add_odometry(CLI::App& program, Action& action);
void add_navmap(CLI::App& program, Action& action);
void add_export(CLI::App& program, Action& action);
void add_merge(CLI::App& program, Action& action);
void add_score(CLI::App& program, Action& action);
void add_check(CLI::App& program, Action& action);
void add_simulate(CLI::App& program, Action& action);
void add_experiment(CLI::App& program, Action& action);
void add_info(CLI::App& program, Action& action);

// The options that set parameters, the same in each command that has them.
struct ConfigOptions {
  std::string file;
  std::vector<std::string> settings;

  void add_to(CLI::App& command);
  // Defaults, then the file, then `shorthands` (what other options stand for), then --set.
  PipelineConfig load(const Settings& shorthands = {}) const;
};

// The options that choose a part of a data set.
struct SourceOptions {
  std::string source, calibration;
  std::optional<double> start_s, duration_s;
  std::optional<int> max_frames, frame_skip, threads;

  void add_to(CLI::App& command);
  Settings shorthands() const;
  std::unique_ptr<StereoSequence> open(const PipelineConfig& config) const;
};

// Before any work: throws ResourceError when a file of this name could not be made, UsageError when
// it is one of those that the command reads. No name, no file.
void require_output(const std::filesystem::path& file,
                    const std::vector<std::filesystem::path>& inputs = {});

// Prints "stereovox: warning: ..." to standard error.
void warn(const std::string& text);

}  // namespace stereovox
