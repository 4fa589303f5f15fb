// Moravec & Elfes 1985, "High resolution maps from wide angle sonar": two certainties per cell,
// empty and occupied, that only ever grow (method.md C.1).
#pragma once

#include <span>

#include "stereovox/baselines/pseudo_scan.h"
#include "stereovox/navmap/occupancy_grid_2d.h"

namespace stereovox {

struct MoravecElfes1985Params {
  static constexpr const char* kName = "moravec_elfes_1985";

  double min_range_m = 0.4;
  double error_sigmas = 2.0;
  double beam_width_deg = 1.0;
  bool per_beam = false;

  void describe(ParameterList& list);
};

// What a reading says at one distance and angle: certainties in [0, 1].
struct MoravecElfesProfile {
  double range_m, error_m, beam_width_rad, min_range_m;

  double empty(double distance_m, double off_axis_rad) const;     // E_r E_a
  double occupied(double distance_m, double off_axis_rad) const;  // O_r O_a

 private:
  double across(double off_axis_rad) const;  // E_a = O_a
};

// Of a beam with a reading on cells of a size.
MoravecElfesProfile profile_of(const Beam& beam, double cell_size_m,
                               const MoravecElfes1985Params& params);

// The state is (v + 1) / 2 with the map's signed certainty v. A beam without a reading empties the
// cells up to its free range. Throws Error when the grid has no cells or too many.
OccupancyGrid2D build_map(std::span<const PseudoScan> scans, const GridGeometry& geometry,
                          const MoravecElfes1985Params& params);

}  // namespace stereovox
