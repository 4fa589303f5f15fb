// What a map says of places that no sight line can have reached. Nobody sees free space that does
// not hang together with the robot's, nor an obstacle that no free space touches: both are the work
// of wrong matches, which put points behind walls. The ideal map leaves such cells out as well
// (method.md B.4, steps 2 to 4).
#pragma once

#include "stereovox/navmap/occupancy_grid_2d.h"

namespace stereovox {

// Free cells outside the largest piece of free space become unknown, then occupied cells without a
// free cell within 0.25 m, or among their eight neighbours when cells are larger.
void forget_hidden_cells(OccupancyGrid2D& map);

}  // namespace stereovox
