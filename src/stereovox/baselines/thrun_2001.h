// Thrun 2001, "Learning occupancy grids with forward models" (also 2003): the most likely map of
// the full joint space, by EM over what caused each reading (method.md C.5). A batch method.
//
// The causes of a reading: 0 the random one, 1 the maximum range ("nothing"), 2 + i the i-th
// occupied cell on the beam.
#pragma once

#include <span>
#include <vector>

#include "stereovox/baselines/pseudo_scan.h"
#include "stereovox/navmap/occupancy_grid_2d.h"

namespace stereovox {

struct Thrun2001Params {
  static constexpr const char* kName = "thrun_2001";

  double hit_probability = 0.9;      // p_h: an occupied cell stops the beam
  double random_probability = 0.05;  // p_r: the reading has no cause
  double max_reading_m = 8.0;        // z_max
  double occupied_prior = 0.1;       // P0
  double keyframe_distance_m = 0.2;
  double keyframe_angle_deg = 10.0;
  int max_sweeps = 20;
  int max_iterations = 20;
  int anneal_iterations = 5;
  double anneal_factor = 4.0;
  double crossing_sigmas = 3.0;
  double min_state = 0.01;

  void describe(ParameterList& list);
};

// The E-step for one reading: the probability of each cause, given the distances of the occupied
// cells on the beam, nearest first. They sum to 1.
std::vector<double> cause_probabilities(double reading_m, double sigma_m,
                                        std::span<const double> obstacles_m,
                                        const Thrun2001Params& params);

// The scans that moved or turned far enough from the one kept before; the first is kept.
std::vector<PseudoScan> keyframes(std::span<const PseudoScan> scans, const Thrun2001Params& params);

// The state of a cell that a beam crossed is its probability given all other cells, within
// [min_state, 1 - min_state]; other cells are unknown, and so are those behind all readings unless
// the map needs them occupied. Throws Error when the grid has no cells or too many.
//
// With the expectations held fixed during a whole sweep, the empty map that EM begins with would
// stay: no reading is expected at an obstacle that is not there. So each trial flip of a cell
// repeats the E-step of the beams that cross it, and is kept when the likelihood of the readings
// rises (incremental EM; Neal & Hinton 1998).
OccupancyGrid2D build_map(std::span<const PseudoScan> scans, const GridGeometry& geometry,
                          const Thrun2001Params& params);

}  // namespace stereovox
