#include "stereovox/baselines/matthies_elfes_1988.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "stereovox/baselines/beam_cells.h"
#include "stereovox/baselines/frame_evidence.h"
#include "stereovox/baselines/grid_values.h"
#include "stereovox/baselines/normal_distribution.h"

namespace stereovox {
namespace {

constexpr double kTail_sigmas = 8.0;  // both tails are below 1e-14 there

// Integral of Phi from minus infinity to t.
double integral_of_cdf(double t) { return t * normal_cdf(t) + normal_density(t); }

void add_beam(const GridGeometry& geometry, const Ray2D& ray, const Beam& beam,
              const MatthiesElfes1988Params& params, FrameEvidence& frame) {
  const MatthiesElfesProfile profile{beam.range_m, beam.sigma_m, params.free_probability,
                                     params.occupied_probability};
  const double free_log_odds = log_odds_of(params.free_probability);
  const double size_m = geometry.cell_size_m;
  const double free_until_m =
      beam.has_range ? beam.range_m - kTail_sigmas * beam.sigma_m : beam.free_range_m + size_m;
  const double length_m =
      beam.has_range ? beam.range_m + params.cut_sigmas * beam.sigma_m : beam.free_range_m;
  for_each_beam_cell(geometry, ray, length_m, [&](const BeamCell& cell) {
    const bool is_free = cell.distance_m + 0.5 * size_m < free_until_m;
    frame.add(cell.position, is_free
                                 ? free_log_odds
                                 : log_odds_of(profile.mean_over_cell(cell.distance_m, size_m)));
  });
}

}  // namespace

void MatthiesElfes1988Params::describe(ParameterList& list) {
  list("free_probability", free_probability, {0.001, 0.5}, "p_f: occupancy before the reading");
  list("occupied_probability", occupied_probability, {0.5, 0.999}, "p_o: peak at the reading");
  list("cut_sigmas", cut_sigmas, {0, 10}, "cells farther behind the reading get no evidence");
  list("max_log_odds", max_log_odds, {1, 700}, "log-odds stay within this");
  list("per_beam", per_beam, "each beam counts, not each frame");
}

double MatthiesElfesProfile::at(double distance_m) const {
  const double t = (distance_m - range_m) / sigma_m;
  return free_probability + (0.5 - free_probability) * normal_cdf(t) +
         (occupied_probability - 0.5) * kSqrtTwoPi * normal_density(t);
}

double MatthiesElfesProfile::mean_over_cell(double center_m, double cell_size_m) const {
  const double near = (center_m - 0.5 * cell_size_m - range_m) / sigma_m;
  const double far = (center_m + 0.5 * cell_size_m - range_m) / sigma_m;
  const double mean_cdf = (integral_of_cdf(far) - integral_of_cdf(near)) / (far - near);
  const double mean_peak = kSqrtTwoPi * (normal_cdf(far) - normal_cdf(near)) / (far - near);
  return free_probability + (0.5 - free_probability) * mean_cdf +
         (occupied_probability - 0.5) * mean_peak;
}

OccupancyGrid2D build_map(std::span<const PseudoScan> scans, const GridGeometry& geometry,
                          const MatthiesElfes1988Params& params) {
  std::vector<double> log_odds(cell_count(geometry), 0.0);
  FrameEvidence frame(log_odds.size());
  const auto apply = [&](std::size_t position, double evidence) {
    log_odds[position] =
        std::clamp(log_odds[position] + evidence, -params.max_log_odds, params.max_log_odds);
  };
  for (const PseudoScan& scan : scans) {
    for (const Beam& beam : scan.beams) {
      add_beam(geometry, {scan.position_m, scan.heading_rad + beam.bearing_rad}, beam, params,
               frame);
      if (params.per_beam) frame.hand_over(apply);
    }
    frame.hand_over(apply);
  }
  return grid_of_log_odds(geometry, log_odds);
}

}  // namespace stereovox
