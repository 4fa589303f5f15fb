// report.json: what a run did, in numbers, for programs (formats.md of the command line lists the
// fields that are always there).
#pragma once

#include <nlohmann/json.hpp>

#include "stereovox/navmap/occupancy_grid_2d.h"
#include "stereovox/pipeline/build_maps.h"

namespace stereovox {

struct MapCounts {
  std::size_t observed = 0, occupied = 0, free = 0;  // voxels
};

// Occupied: state above `threshold`.
MapCounts count_voxels(const VoxelMap& map, double threshold);

nlohmann::ordered_json report(const StereoSequence& sequence, const PipelineConfig& config,
                              const BuildResult& result);

// Largest resident memory of this process so far.
std::size_t peak_rss_bytes();

}  // namespace stereovox
