// Where the evidence for one surface is spread over two layers of cells, the surface lies in one of
// them: where the mean of its points is, or in the layer that has more evidence.
#pragma once

#include "stereovox/navmap/navmap_params.h"
#include "stereovox/navmap/occupancy_grid_2d.h"
#include "stereovox/navmap/wall_faces.h"

namespace stereovox {

// Looks at each cell between a free cell and, on the opposite side, an occupied one. Where the mean
// of the surface's points, seen from the free side, is known (WallFaces::reach_m):
//   an occupied cell that they do not reach becomes free, unless its state is params.sure_state or
//   more; another cell that they reach becomes occupied;
//   where the mean is behind the border by less than params.face_bias_m, such a cell becomes
//   unknown.
// Elsewhere an occupied cell becomes free when the state behind it is higher by more than
// params.wall_contrast: what was measured in it is the error of the surface behind. A cell that is
// really filled is nearer to those who look and collects more evidence than the one behind it.
void thin_walls(OccupancyGrid2D& map, const WallFaces& faces, const NavmapParams& params);

}  // namespace stereovox
