// The files that people read of an experiment.
#pragma once

#include <filesystem>
#include <span>

#include "stereovox/experiment/result_table.h"

namespace stereovox {

// report.md, results.csv, experiment.yaml, parameters.txt and figures/ in the folder whose maps/
// map_drive filled. Throws ResourceError, and Error when a map is missing.
void write_report(const ExperimentConfig& config, std::span<const ResultRow> rows,
                  const std::filesystem::path& output);

}  // namespace stereovox
