// The paper's experiment: every method on the same stereo data of every world, scored against the
// known plan.
//
// The output folder then holds report.md (tables as the paper's Table 1, figures), results.csv (all
// figures of all maps), experiment.yaml (as given), parameters.txt (every parameter as used),
// maps/ (every map and ideal map) and figures/. runs/ keeps what was finished, so that a stopped
// experiment goes on where it was.
#pragma once

#include <filesystem>
#include <vector>

#include "stereovox/experiment/recorded_drive.h"
#include "stereovox/experiment/result_table.h"

namespace stereovox {

struct ExperimentProgress {
  std::function<void(const std::string&)> say = [](const std::string&) {};  // from any thread
  std::function<bool()> should_stop = [] { return false; };
};

struct ExperimentResult {
  std::vector<ResultRow> rows;
  bool was_stopped = false;
};

// Drives run on `threads` threads, one each. The results do not depend on their number. `build`
// names the program: results of another one are made anew. Throws Error, ResourceError.
ExperimentResult run_experiment(const ExperimentConfig& config, const std::filesystem::path& output,
                                const std::filesystem::path& cache, const std::string& build,
                                int threads, const ExperimentProgress& progress);

}  // namespace stereovox
