// Matthies & Elfes 1988, "Integration of sonar and stereo range data using a grid-based
// representation": Bayes' rule with one range profile per sensor (method.md C.2).
#pragma once

#include <span>

#include "stereovox/baselines/pseudo_scan.h"
#include "stereovox/navmap/occupancy_grid_2d.h"

namespace stereovox {

struct MatthiesElfes1988Params {
  static constexpr const char* kName = "matthies_elfes_1988";

  double free_probability = 0.3;      // p_f, before the reading
  double occupied_probability = 0.9;  // p_o, of the peak at the reading
  double cut_sigmas = 3.0;
  double max_log_odds = 50.0;  // far beyond belief: no clamp, but no overflow either
  bool per_beam = false;

  void describe(ParameterList& list);
};

// p(x | R) = p_f + (.5 - p_f) Phi((x - R)/s) + (p_o - .5) exp(-(x - R)^2 / (2 s^2)).
struct MatthiesElfesProfile {
  double range_m, sigma_m;
  double free_probability, occupied_probability;

  double at(double distance_m) const;
  // Its exact mean over a cell of that centre and length.
  double mean_over_cell(double center_m, double cell_size_m) const;
};

// The state is the posterior occupancy, prior one half. A beam without a reading gives p_f up to
// its free range. Throws Error when the grid has no cells or too many.
OccupancyGrid2D build_map(std::span<const PseudoScan> scans, const GridGeometry& geometry,
                          const MatthiesElfes1988Params& params);

}  // namespace stereovox
