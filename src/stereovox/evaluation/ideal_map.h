// What a perfect map of a known floor plan would be (method.md, B.4). The paper compares with two:
// the theoretical map T (eq. 19, correlation) and the normalised map N (eq. 20, map score), which
// leaves out what no robot could know.
//
//   const IdealMap ideal = make_ideal(read_map_server("plan.yaml").grid, start_m);
#pragma once

#include <optional>

#include "stereovox/navmap/cell_mask.h"

namespace stereovox {

struct IdealMap {
  OccupancyGrid2D theoretical;  // occupied as in the plan, all else free: two values
  // Free: what is joined to the start over edges of free cells. Occupied: the plan's occupied cells
  // with a free cell among their eight neighbours. All else unknown: outside, inside of solids.
  OccupancyGrid2D normalised;
};

// Unknown cells of the plan are not free. Without a start, the largest piece of free cells counts.
// Throws Error when the plan has no free cell, or the start is on none.
IdealMap make_ideal(const OccupancyGrid2D& plan, std::optional<Eigen::Vector2d> start_m);

// N_vis: cells outside `visible` (of the same geometry) are unknown in the normalised map.
IdealMap restricted_to(const IdealMap& ideal, const CellMask& visible);

// Both maps on another extent of their lattice: beyond the plan, all is unknown.
IdealMap extended_to(const IdealMap& ideal, const GridGeometry& region);

// For planning: occupied as T, free as N, all else unknown.
OccupancyGrid2D planning_map(const IdealMap& ideal);

}  // namespace stereovox
