// Where the evidence for one surface is spread over two layers of cells, the surface lies in the
// layer that has more of it.
#pragma once

#include "stereovox/navmap/occupancy_grid_2d.h"

namespace stereovox {

// An occupied cell between a free cell and, on the opposite side, an occupied cell whose
// state is higher by more than `contrast` becomes free: what was measured in it is the error of the
// surface behind. A cell that is really filled is nearer to those who look and collects more
// evidence than the one behind it.
void thin_walls(OccupancyGrid2D& map, double contrast);

}  // namespace stereovox
