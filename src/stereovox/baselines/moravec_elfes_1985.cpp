#include "stereovox/baselines/moravec_elfes_1985.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "stereovox/baselines/beam_cells.h"
#include "stereovox/baselines/grid_values.h"
#include "stereovox/core/angles.h"

namespace stereovox {
namespace {

constexpr double kMinBeamSum = 1e-6;  // a beam that hits nothing new has no sum to divide by

double add_certainty(double old, double added) { return old + added - old * added; }

// The largest certainty that the beams of one frame give each cell.
class FrameCertainty {
 public:
  explicit FrameCertainty(std::size_t cells) : certainty_(cells, 0.0) {}

  void add(std::size_t position, double certainty) {
    if (certainty_[position] == 0.0) touched_.push_back(position);
    certainty_[position] = std::max(certainty_[position], certainty);
  }
  double at(std::size_t position) const { return certainty_[position]; }
  void clear() {
    for (const std::size_t position : touched_) certainty_[position] = 0.0;
    touched_.clear();
  }
  std::span<const std::size_t> touched() const { return touched_; }

 private:
  std::vector<double> certainty_;
  std::vector<std::size_t> touched_;
};

struct BeamCertainty {
  std::size_t position;
  double empty, occupied;
};

class MoravecElfesGrid {
 public:
  MoravecElfesGrid(const GridGeometry& geometry, const MoravecElfes1985Params& params)
      : geometry_(geometry),
        params_(params),
        empty_(cell_count(geometry), 0.0),
        occupied_(empty_.size(), 0.0),
        frame_empty_(empty_.size()),
        frame_hit_(empty_.size()),
        frame_occupied_(empty_.size()) {}

  // One sweep: first all empty parts, then each beam's occupied part.
  void integrate(const PseudoScan& scan) {
    std::vector<std::vector<BeamCertainty>> beams;
    for (const Beam& beam : scan.beams) beams.push_back(certainties_of(scan, beam));
    add_empty(beams);
    for (const auto& beam : beams) add_occupied(beam);
    for (const std::size_t position : frame_occupied_.touched())
      occupied_[position] = add_certainty(occupied_[position], frame_occupied_.at(position));
    frame_occupied_.clear();
  }

  OccupancyGrid2D map() const {
    std::vector<double> values(empty_.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double signed_certainty = occupied_[i] >= empty_[i] ? occupied_[i] : -empty_[i];
      values[i] = 0.5 * (signed_certainty + 1.0);
    }
    return grid_of_values(geometry_, values);
  }

 private:
  std::vector<BeamCertainty> certainties_of(const PseudoScan& scan, const Beam& beam) const {
    const MoravecElfesProfile profile = profile_of(beam, geometry_.cell_size_m, params_);
    const double direction_rad = scan.heading_rad + beam.bearing_rad;
    std::vector<BeamCertainty> cells;
    for_each_beam_cell(
        geometry_, {scan.position_m, direction_rad}, profile.range_m + profile.error_m,
        [&](const BeamCell& cell) {
          const Eigen::Vector2d offset_m = center_of(geometry_, cell.cell) - scan.position_m;
          const double off_axis_rad = std::acos(std::min(1.0, cell.distance_m / offset_m.norm()));
          cells.push_back({cell.position, profile.empty(offset_m.norm(), off_axis_rad),
                           beam.has_range ? profile.occupied(offset_m.norm(), off_axis_rad) : 0.0});
        });
    return cells;
  }

  void add_empty(std::span<const std::vector<BeamCertainty>> beams) {
    for (const auto& beam : beams)
      for (const BeamCertainty& cell : beam) {
        if (params_.per_beam)
          empty_[cell.position] = add_certainty(empty_[cell.position], cell.empty);
        else if (cell.occupied > 0.0)
          frame_hit_.add(cell.position, cell.occupied);
        else if (cell.empty > 0.0)
          frame_empty_.add(cell.position, cell.empty);
      }
    for (const std::size_t position : frame_empty_.touched())
      if (frame_hit_.at(position) == 0.0)
        empty_[position] = add_certainty(empty_[position], frame_empty_.at(position));
    frame_empty_.clear();
    frame_hit_.clear();
  }

  // Cancel by what is known empty, normalise over the beam, enhance.
  void add_occupied(std::span<const BeamCertainty> beam) {
    double sum = 0.0;
    for (const BeamCertainty& cell : beam) sum += cell.occupied * (1.0 - empty_[cell.position]);
    if (sum < kMinBeamSum) return;
    for (const BeamCertainty& cell : beam) {
      const double normalised = cell.occupied * (1.0 - empty_[cell.position]) / sum;
      if (normalised <= 0.0) continue;
      if (params_.per_beam)
        occupied_[cell.position] = add_certainty(occupied_[cell.position], normalised);
      else
        frame_occupied_.add(cell.position, normalised);
    }
  }

  GridGeometry geometry_;
  MoravecElfes1985Params params_;
  std::vector<double> empty_, occupied_;
  FrameCertainty frame_empty_, frame_hit_, frame_occupied_;
};

}  // namespace

void MoravecElfes1985Params::describe(ParameterList& list) {
  list("min_range_m", min_range_m, {0, 10}, "nearer cells get no evidence");
  list("error_sigmas", error_sigmas, {0.1, 10}, "half width of the occupied part, in sigmas");
  list("beam_width_deg", beam_width_deg, {0.05, 30}, "least width of a beam");
  list("per_beam", per_beam, "each beam counts, not each frame");
}

double MoravecElfesProfile::across(double off_axis_rad) const {
  const double share = 2.0 * off_axis_rad / beam_width_rad;
  return std::max(0.0, 1.0 - share * share);
}

double MoravecElfesProfile::empty(double distance_m, double off_axis_rad) const {
  const double end_m = range_m - error_m;
  if (distance_m < min_range_m || distance_m >= end_m) return 0.0;
  const double share = (distance_m - min_range_m) / (end_m - min_range_m);
  return (1.0 - share * share) * across(off_axis_rad);
}

double MoravecElfesProfile::occupied(double distance_m, double off_axis_rad) const {
  const double share = (distance_m - range_m) / error_m;
  return std::max(0.0, 1.0 - share * share) * across(off_axis_rad);
}

MoravecElfesProfile profile_of(const Beam& beam, double cell_size_m,
                               const MoravecElfes1985Params& params) {
  const double range_m = clear_range_m(beam);
  const double sigma_m = beam.has_range ? beam.sigma_m : 0.0;
  return {.range_m = range_m,
          .error_m = std::max(0.5 * cell_size_m, params.error_sigmas * sigma_m),
          .beam_width_rad =
              std::max(params.beam_width_deg * kDegree_rad, std::atan2(cell_size_m, range_m)),
          .min_range_m = params.min_range_m};
}

OccupancyGrid2D build_map(std::span<const PseudoScan> scans, const GridGeometry& geometry,
                          const MoravecElfes1985Params& params) {
  MoravecElfesGrid grid(geometry, params);
  for (const PseudoScan& scan : scans) grid.integrate(scan);
  return grid.map();
}

}  // namespace stereovox
