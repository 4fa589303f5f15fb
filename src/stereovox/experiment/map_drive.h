// All methods on one recorded drive: maps and their scores.
#pragma once

#include <filesystem>
#include <vector>

#include "stereovox/experiment/recorded_drive.h"
#include "stereovox/experiment/result_table.h"

namespace stereovox {

struct DriveCase {
  std::string world;
  int seed = 0;
};

// Maps every group of the experiment that names the drive's seed, with each of its pose sources and
// cell sizes; a frame without an estimated pose touches no map there. Maps go to
// <maps>/<file name of their case>.yaml, the ideal maps beside them, and for the first seed
// pictures of the voxels of the first group. Nothing when it was stopped.
std::optional<std::vector<ResultRow>> map_drive(const ExperimentConfig& config,
                                                const RecordedDrive& drive, const DriveCase& of,
                                                const std::filesystem::path& maps,
                                                const RecordingProgress& progress);

// "office_s1_truth_025cm_corrected", the group's title before the method where it is not the first.
std::string file_name(const MapCase& of);
std::string ideal_file_name(const DriveCase& of, double cell_size_m);

}  // namespace stereovox
