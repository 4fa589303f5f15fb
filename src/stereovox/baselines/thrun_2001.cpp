#include "stereovox/baselines/thrun_2001.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "stereovox/baselines/beam_cells.h"
#include "stereovox/baselines/grid_values.h"
#include "stereovox/baselines/normal_distribution.h"
#include "stereovox/core/angles.h"

namespace stereovox {
namespace {

double density(double x_m, double mean_m, double sigma_m) {
  return normal_density((x_m - mean_m) / sigma_m) / sigma_m;
}

// Sums prior times likelihood over the causes of a reading. Obstacles are added nearest first.
class CauseSum {
 public:
  CauseSum(const Thrun2001Params& params, double random_likelihood)
      : hit_(params.hit_probability),
        reaches_(1.0 - params.random_probability),
        sum_(params.random_probability * random_likelihood) {}

  // Returns the obstacle's own term.
  double add_obstacle(double likelihood) {
    const double term = reaches_ * hit_ * likelihood;
    reaches_ *= 1.0 - hit_;
    sum_ += term;
    return term;
  }
  double maximum_term(double likelihood) const { return reaches_ * likelihood; }
  double with_maximum(double likelihood) const { return sum_ + maximum_term(likelihood); }

 private:
  double hit_, reaches_, sum_;  // reaches: the beam passed all obstacles so far
};

// One beam's passage through one cell.
struct Crossing {
  std::uint32_t cell, beam;
  double distance_m;
  double likelihood;  // of the reading, if this cell caused it
};

struct EmBeam {
  std::size_t first = 0, end = 0;  // its crossings, nearest first
  double reading_m = 0, sigma_m = 0;
  bool has_range = false;
  double maximum_likelihood = 0;
  double log_likelihood = 0;  // of the reading, in the map as it is
};

class EmMap {
 public:
  EmMap(std::span<const PseudoScan> scans, const GridGeometry& geometry,
        const Thrun2001Params& params)
      : geometry_(geometry),
        params_(params),
        is_occupied_(cell_count(geometry), 0),
        is_seen_(is_occupied_.size(), 0),
        is_stale_(is_occupied_.size(), 1) {
    for (const PseudoScan& scan : scans)
      for (const Beam& beam : scan.beams)
        if (clear_range_m(beam) > 0.0) add_beam(scan, beam);
    sort_crossings_by_cell();
  }

  void run() {
    for (int i = 0; i < params_.max_iterations; ++i) {
      const double progress = static_cast<double>(i) / std::max(1, params_.anneal_iterations);
      const double factor =
          params_.anneal_factor + (1.0 - params_.anneal_factor) * std::min(1.0, progress);
      set_sigma_factor(factor);
      const bool is_changed = sweep_until_stable();
      if (!is_changed && progress >= 1.0) return;
    }
  }

  OccupancyGrid2D map() {
    std::vector<double> values(is_occupied_.size(), 0.5);
    for (std::uint32_t cell = 0; cell < values.size(); ++cell) {
      if (!is_seen_[cell] && !is_occupied_[cell]) continue;
      const double gain = gain_of_flip(cell);
      values[cell] = std::clamp(probability_of(is_occupied_[cell] ? -gain : gain),
                                params_.min_state, 1.0 - params_.min_state);
    }
    return grid_of_values(geometry_, values);
  }

 private:
  void add_beam(const PseudoScan& scan, const Beam& beam) {
    const double sigma_m = std::max(beam.sigma_m, 0.5 * geometry_.cell_size_m);
    EmBeam added{.first = crossings_.size(),
                 .reading_m = clear_range_m(beam),
                 .sigma_m = sigma_m,
                 .has_range = beam.has_range};
    const double length_m =
        added.reading_m + (beam.has_range ? params_.crossing_sigmas * sigma_m : 0.0);
    const Ray2D ray{scan.position_m, scan.heading_rad + beam.bearing_rad};
    for_each_beam_cell(geometry_, ray, length_m, [&](const BeamCell& cell) {
      crossings_.push_back({static_cast<std::uint32_t>(cell.position),
                            static_cast<std::uint32_t>(beams_.size()), cell.distance_m, 0.0});
      if (cell.enter_m < added.reading_m) is_seen_[cell.position] = 1;
    });
    added.end = crossings_.size();
    beams_.push_back(added);
  }

  void sort_crossings_by_cell() {
    first_of_cell_.assign(is_occupied_.size() + 1, 0);
    for (const Crossing& crossing : crossings_) ++first_of_cell_[crossing.cell + 1];
    for (std::size_t i = 1; i < first_of_cell_.size(); ++i)
      first_of_cell_[i] += first_of_cell_[i - 1];
    beams_of_cell_.resize(crossings_.size());
    std::vector<std::size_t> next(first_of_cell_.begin(), first_of_cell_.end() - 1);
    for (const Crossing& crossing : crossings_)
      beams_of_cell_[next[crossing.cell]++] = crossing.beam;
  }

  // All expectations depend on the sigmas.
  void set_sigma_factor(double factor) {
    if (factor == sigma_factor_) return;
    sigma_factor_ = factor;
    for (EmBeam& beam : beams_) {
      const double sigma_m = factor * beam.sigma_m;
      beam.maximum_likelihood =
          beam.has_range ? density(beam.reading_m, params_.max_reading_m, sigma_m) : 1.0;
      for (std::size_t i = beam.first; i < beam.end; ++i)
        crossings_[i].likelihood = beam.has_range
                                       ? density(beam.reading_m, crossings_[i].distance_m, sigma_m)
                                       : double(crossings_[i].distance_m > beam.reading_m);
      beam.log_likelihood = log_likelihood(beam);
    }
    std::ranges::fill(is_stale_, 1);
  }

  double log_likelihood(const EmBeam& beam) const {
    CauseSum causes(params_, 1.0 / params_.max_reading_m);
    for (std::size_t i = beam.first; i < beam.end; ++i)
      if (is_occupied_[crossings_[i].cell]) causes.add_obstacle(crossings_[i].likelihood);
    return std::log(causes.with_maximum(beam.maximum_likelihood));
  }

  std::span<const std::uint32_t> beams_of(std::uint32_t cell) const {
    return std::span(beams_of_cell_)
        .subspan(first_of_cell_[cell], first_of_cell_[cell + 1] - first_of_cell_[cell]);
  }

  // How much the logarithm of the map's probability rises when the cell changes.
  double gain_of_flip(std::uint32_t cell) {
    const double prior = log_odds_of(params_.occupied_prior);
    double gain = is_occupied_[cell] ? -prior : prior;
    is_occupied_[cell] ^= 1;
    for (const std::uint32_t beam : beams_of(cell))
      gain += log_likelihood(beams_[beam]) - beams_[beam].log_likelihood;
    is_occupied_[cell] ^= 1;
    return gain;
  }

  void flip(std::uint32_t cell) {
    is_occupied_[cell] ^= 1;
    for (const std::uint32_t index : beams_of(cell)) {
      EmBeam& beam = beams_[index];
      beam.log_likelihood = log_likelihood(beam);
      for (std::size_t i = beam.first; i < beam.end; ++i) is_stale_[crossings_[i].cell] = 1;
    }
  }

  struct Candidate {
    double gain;
    std::uint32_t cell;
  };

  // The cells that gain by a flip, of those whose beams changed since their last trial. The best
  // come first: in order of position, a reading would be explained by the first cell near enough,
  // and single flips seldom move an obstacle later.
  std::vector<Candidate> candidates() {
    std::vector<Candidate> found;
    for (std::uint32_t cell = 0; cell < is_occupied_.size(); ++cell) {
      if (!is_stale_[cell] || beams_of(cell).empty()) continue;
      is_stale_[cell] = 0;
      if (const double gain = gain_of_flip(cell); gain > 0.0) found.push_back({gain, cell});
    }
    std::ranges::stable_sort(found, std::greater<>(), &Candidate::gain);
    return found;
  }

  // Flips each candidate that still gains; false when there is none.
  bool sweep() {
    bool is_changed = false;
    for (const Candidate& candidate : candidates()) {
      if (is_stale_[candidate.cell] && gain_of_flip(candidate.cell) <= 0.0) continue;
      flip(candidate.cell);
      is_changed = true;
    }
    return is_changed;
  }

  bool sweep_until_stable() {
    bool is_changed = false;
    for (int i = 0; i < params_.max_sweeps && sweep(); ++i) is_changed = true;
    return is_changed;
  }

  GridGeometry geometry_;
  Thrun2001Params params_;
  std::vector<std::uint8_t> is_occupied_, is_seen_, is_stale_;
  std::vector<EmBeam> beams_;
  std::vector<Crossing> crossings_;
  std::vector<std::size_t> first_of_cell_;
  std::vector<std::uint32_t> beams_of_cell_;
  double sigma_factor_ = 0.0;  // none yet
};

}  // namespace

void Thrun2001Params::describe(ParameterList& list) {
  list("hit_probability", hit_probability, {0.01, 0.99}, "p_h: an occupied cell stops the beam");
  list("random_probability", random_probability, {0.0001, 0.9}, "p_r: a reading has no cause");
  list("max_reading_m", max_reading_m, {0.1, 1000}, "z_max: what a beam reads that meets nothing");
  list("occupied_prior", occupied_prior, {0.001, 0.999}, "P0: share of cells that are occupied");
  list("keyframe_distance_m", keyframe_distance_m, {0, 100},
       "scans nearer to the last are left out");
  list("keyframe_angle_deg", keyframe_angle_deg, {0, 180}, "unless they turned by this");
  list("max_sweeps", max_sweeps, {1, 1000}, "sweeps over the map per iteration");
  list("max_iterations", max_iterations, {1, 1000}, "iterations of EM");
  list("anneal_iterations", anneal_iterations, {0, 1000}, "iterations until sigma has its value");
  list("anneal_factor", anneal_factor, {1, 100}, "factor of sigma in the first iteration");
  list("crossing_sigmas", crossing_sigmas, {0, 10}, "cells this far behind may explain a reading");
  list("min_state", min_state, {0, 0.5}, "states stay this far from 0 and 1");
}

std::vector<double> cause_probabilities(double reading_m, double sigma_m,
                                        std::span<const double> obstacles_m,
                                        const Thrun2001Params& params) {
  const double random_likelihood = 1.0 / params.max_reading_m;
  CauseSum causes(params, random_likelihood);
  std::vector<double> terms = {params.random_probability * random_likelihood, 0.0};
  for (const double distance_m : obstacles_m)
    terms.push_back(causes.add_obstacle(density(reading_m, distance_m, sigma_m)));
  const double maximum_likelihood = density(reading_m, params.max_reading_m, sigma_m);
  terms[1] = causes.maximum_term(maximum_likelihood);
  for (double& term : terms) term /= causes.with_maximum(maximum_likelihood);
  return terms;
}

std::vector<PseudoScan> keyframes(std::span<const PseudoScan> scans,
                                  const Thrun2001Params& params) {
  std::vector<PseudoScan> kept;
  for (const PseudoScan& scan : scans) {
    const auto is_far = [&](const PseudoScan& last) {
      const double turn_rad = std::remainder(scan.heading_rad - last.heading_rad, 2.0 * M_PI);
      return (scan.position_m - last.position_m).norm() >= params.keyframe_distance_m ||
             std::abs(turn_rad) >= params.keyframe_angle_deg * kDegree_rad;
    };
    if (kept.empty() || is_far(kept.back())) kept.push_back(scan);
  }
  return kept;
}

OccupancyGrid2D build_map(std::span<const PseudoScan> scans, const GridGeometry& geometry,
                          const Thrun2001Params& params) {
  EmMap map(keyframes(scans, params), geometry, params);
  map.run();
  return map.map();
}

}  // namespace stereovox
