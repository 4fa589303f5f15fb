#include "stereovox/baselines/konolige_1997.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "stereovox/baselines/beam_cells.h"
#include "stereovox/baselines/frame_evidence.h"
#include "stereovox/baselines/grid_values.h"
#include "stereovox/baselines/normal_distribution.h"

namespace stereovox {
namespace {

constexpr int kFewBearings = 5, kManyBearings = 8, kRanges = 2;
// Where the tails of the normal distribution no longer change a likelihood ratio.
constexpr double kNegligible_sigmas = 6.0;
constexpr double kMinTargetSigma_m = 1e-6;  // of a cell at the camera itself

int bucket_count(const Konolige1997Params& params) {
  return params.pose_buckets == PoseBuckets::five_bearings ? kFewBearings : kManyBearings * kRanges;
}

class MurielGrid {
 public:
  MurielGrid(const GridGeometry& geometry, const Konolige1997Params& params)
      : geometry_(geometry),
        params_(params),
        buckets_(static_cast<std::size_t>(bucket_count(params))),
        log_odds_(cell_count(geometry), 0.0),
        stored_(log_odds_.size() * buckets_, 0.0),
        frame_(log_odds_.size()) {}

  void integrate(const PseudoScan& scan) {
    const auto apply = [&](std::size_t position, double evidence) {
      accept(position, scan.position_m, evidence);
    };
    for (const Beam& beam : scan.beams) {
      add_beam({scan.position_m, scan.heading_rad + beam.bearing_rad}, beam);
      if (params_.per_beam) frame_.hand_over(apply);
    }
    frame_.hand_over(apply);
  }

  OccupancyGrid2D map() const { return grid_of_log_odds(geometry_, log_odds_); }

 private:
  void add_beam(const Ray2D& ray, const Beam& beam) {
    const double trust =
        params_.specular && beam.has_range
            ? 1.0 - spurious_probability(blocked_probability(ray, beam), beam, params_)
            : 1.0;
    const double length_m =
        beam.has_range ? beam.range_m + kNegligible_sigmas * beam.sigma_m : beam.free_range_m;
    for_each_beam_cell(geometry_, ray, length_m, [&](const BeamCell& cell) {
      const double ratio = likelihood_ratio(cell.distance_m, geometry_.cell_size_m, beam, params_);
      frame_.add(cell.position, trust * std::log(ratio));
    });
  }

  // 1 - the probability that all cells well before the reading are free.
  double blocked_probability(const Ray2D& ray, const Beam& beam) const {
    double open = 1.0;
    const double until_m = beam.range_m - params_.specular_sigmas * beam.sigma_m;
    for_each_beam_cell(geometry_, ray, until_m, [&](const BeamCell& cell) {
      const bool is_before = cell.distance_m + 0.5 * geometry_.cell_size_m < until_m;
      const double log_odds = log_odds_[cell.position];
      if (is_before && log_odds > 0.0) open *= 1.0 - probability_of(log_odds);
    });
    return 1.0 - open;
  }

  // Evidence from a used bucket only counts by what it exceeds the stored one.
  void accept(std::size_t position, const Eigen::Vector2d& robot_m, double evidence) {
    const auto width = static_cast<std::size_t>(geometry_.width);
    const Eigen::Vector2i cell(static_cast<int>(position % width),
                               static_cast<int>(position / width));
    const int bucket = pose_bucket(center_of(geometry_, cell), robot_m, params_);
    double& stored = stored_[position * buckets_ + static_cast<std::size_t>(bucket)];
    if (std::abs(evidence) <= std::abs(stored)) return;
    log_odds_[position] = std::clamp(log_odds_[position] + evidence - stored, -params_.max_log_odds,
                                     params_.max_log_odds);
    stored = evidence;
  }

  GridGeometry geometry_;
  Konolige1997Params params_;
  std::size_t buckets_;
  std::vector<double> log_odds_;
  std::vector<double> stored_;  // log lambda by cell and bucket; 0 = the bucket is unused
  FrameEvidence frame_;
};

}  // namespace

std::span<const std::string> names_of(PoseBuckets) {
  static const std::vector<std::string> names = {"five_bearings", "eight_bearings_two_ranges"};
  return names;
}

void Konolige1997Params::describe(ParameterList& list) {
  list("detection", detection, {0.001, 0.999}, "alpha: probability that a near target is read");
  list("detection_end_m", detection_end_m, {0.1, 1000}, "range where alpha has fallen to 0");
  list("false_density_per_m", false_density_per_m, {1e-6, 10}, "F: density of false readings");
  list("pose_buckets", pose_buckets, "from where the evidence for a cell counts separately");
  list("bucket_split_m", bucket_split_m, {0, 100}, "range that parts near buckets from far ones");
  list("specular", specular, "doubt readings from behind what is believed occupied");
  list("specular_sigmas", specular_sigmas, {0, 10},
       "cells this much nearer than the reading can block it");
  list("max_log_odds", max_log_odds, {0.1, 700}, "log-odds stay within this");
  list("per_beam", per_beam, "each beam counts, not each frame");
}

double detection_probability(double range_m, const Konolige1997Params& params) {
  return params.detection * (1.0 - std::clamp(range_m / params.detection_end_m, 0.0, 1.0));
}

double likelihood_ratio(double cell_distance_m, double cell_size_m, const Beam& beam,
                        const Konolige1997Params& params) {
  const double alpha = detection_probability(cell_distance_m, params);
  if (!beam.has_range) return 1.0 - alpha;
  const double nearness = cell_distance_m / beam.range_m;
  const double sigma_m = std::max(kMinTargetSigma_m, beam.sigma_m * nearness * nearness);
  const double behind_m = cell_distance_m - beam.range_m;
  if (behind_m + 0.5 * cell_size_m < -kNegligible_sigmas * sigma_m) return 1.0 - alpha;
  const double within_cell = normal_cdf((behind_m + 0.5 * cell_size_m) / sigma_m) -
                             normal_cdf((behind_m - 0.5 * cell_size_m) / sigma_m);
  const double density_per_m = alpha * within_cell / cell_size_m;
  const double answered_nearer = alpha * normal_cdf(-behind_m / sigma_m);
  return (params.false_density_per_m + density_per_m) * (1.0 - answered_nearer) /
         params.false_density_per_m;
}

double spurious_probability(double blocked, const Beam& beam, const Konolige1997Params& params) {
  const double true_density_per_m =
      detection_probability(beam.range_m, params) / (kSqrtTwoPi * beam.sigma_m);
  const double spurious = blocked * params.false_density_per_m;
  return spurious /
         (spurious + (1.0 - blocked) * (params.false_density_per_m + true_density_per_m));
}

int pose_bucket(const Eigen::Vector2d& cell_m, const Eigen::Vector2d& robot_m,
                const Konolige1997Params& params) {
  const Eigen::Vector2d to_robot_m = robot_m - cell_m;
  const double turn = std::atan2(to_robot_m.y(), to_robot_m.x()) / (2.0 * M_PI);
  const double share = turn < 0.0 ? turn + 1.0 : turn;  // of a full turn, in [0, 1]
  const bool is_five = params.pose_buckets == PoseBuckets::five_bearings;
  const int bearings = is_five ? kFewBearings : kManyBearings;
  const int bearing = std::min(bearings - 1, static_cast<int>(bearings * share));
  const bool is_far = !is_five && to_robot_m.norm() > params.bucket_split_m;
  return is_far ? bearings + bearing : bearing;
}

OccupancyGrid2D build_map(std::span<const PseudoScan> scans, const GridGeometry& geometry,
                          const Konolige1997Params& params) {
  MurielGrid grid(geometry, params);
  for (const PseudoScan& scan : scans) grid.integrate(scan);
  return grid.map();
}

}  // namespace stereovox
