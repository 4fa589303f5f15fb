// Obstacles grown by the robot's radius: where the centre of a round robot cannot be.
#pragma once

#include "stereovox/navmap/occupancy_grid_2d.h"

namespace stereovox {

// A cell becomes occupied, state 1, when its centre is at most `radius_m` from the square of an
// occupied cell; of cells that are (i, j) apart that is
// hypot(max(|i| - 1/2, 0), max(|j| - 1/2, 0)) cells. Radius 0 changes nothing. Throws UsageError
// for a radius outside [0, 100] m.
OccupancyGrid2D inflate(const OccupancyGrid2D& map, double radius_m);

}  // namespace stereovox
