// Thrun 1993, "Exploration and model building in mobile robot domains": a network that was trained
// off-line interprets the scan, Bayes' rule adds up (method.md C.3).
#pragma once

#include <span>

#include "stereovox/baselines/scan_network.h"
#include "stereovox/navmap/occupancy_grid_2d.h"

namespace stereovox {

struct Thrun1993Params {
  static constexpr const char* kName = "thrun_1993";

  double max_range_m = 5.0;  // as the network was trained
  double prior = 0.5;        // P0
  double min_probability = 0.05;
  double max_log_odds = 50.0;

  void describe(ParameterList& list);
};

// Each frame asks the network once for each cell in the view cone; the answer is cut to
// [min_probability, 1 - min_probability]. The state is the posterior occupancy. Throws Error when
// the grid has no cells or too many.
OccupancyGrid2D build_map(std::span<const PseudoScan> scans, const GridGeometry& geometry,
                          const Thrun1993Params& params, const ScanNetwork& network);

// With the network that is compiled in.
OccupancyGrid2D build_map(std::span<const PseudoScan> scans, const GridGeometry& geometry,
                          const Thrun1993Params& params);

}  // namespace stereovox
