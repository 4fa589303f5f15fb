// Konolige 1997, "Improved occupancy grids for map building" (MURIEL): likelihood ratios of single
// targets, one piece of evidence per pose bucket, and doubt of readings that see through what is
// known to be solid (method.md C.4).
#pragma once

#include <span>

#include "stereovox/baselines/pseudo_scan.h"
#include "stereovox/navmap/occupancy_grid_2d.h"

namespace stereovox {

// From where a cell is seen, told apart so that repeated readings from one place count once: five
// bearings, or eight bearings each near and far.
enum class PoseBuckets { five_bearings, eight_bearings_two_ranges };
std::span<const std::string> names_of(PoseBuckets);

struct Konolige1997Params {
  static constexpr const char* kName = "konolige_1997";

  double detection = 0.6;                // alpha at range 0
  double detection_end_m = 10.0;         // range where alpha has fallen to 0
  double false_density_per_m = 0.00625;  // F: .05 over 8 m
  PoseBuckets pose_buckets = PoseBuckets::five_bearings;
  double bucket_split_m = 1.5;
  bool specular = true;
  double specular_sigmas = 3.0;
  double max_log_odds = 10.0;
  bool per_beam = false;

  void describe(ParameterList& list);
};

// alpha(r) = detection (1 - min(1, r / detection_end)).
double detection_probability(double range_m, const Konolige1997Params& params);

// lambda_i = (F + pbar_i(D)) (1 - Q_i) / F of a cell at distance r_i along a beam that reads D. The
// target's sigma is the beam's, scaled as stereo's is: sigma(r_i) = sigma_D (r_i / D)^2.
double likelihood_ratio(double cell_distance_m, double cell_size_m, const Beam& beam,
                        const Konolige1997Params& params);

// Probability that a reading is spurious when something solid stands before it with probability
// `blocked`.
double spurious_probability(double blocked, const Beam& beam, const Konolige1997Params& params);

// The bucket of a cell seen from `robot_m`.
int pose_bucket(const Eigen::Vector2d& cell_m, const Eigen::Vector2d& robot_m,
                const Konolige1997Params& params);

// The state is the posterior occupancy, prior one half. A beam without a reading says of the cells
// up to its free range that they did not answer. Only cells that are believed occupied can block:
// unknown ones, of which there are many before every reading, would make all readings spurious.
// Throws Error when the grid has no cells or too many.
OccupancyGrid2D build_map(std::span<const PseudoScan> scans, const GridGeometry& geometry,
                          const Konolige1997Params& params);

}  // namespace stereovox
