// Where the evidence for one surface is spread over two layers of cells, or lies in the layer
// before the one that the surface belongs to, because it stands near their border.
#pragma once

#include <vector>

#include "stereovox/navmap/navmap_params.h"
#include "stereovox/navmap/occupancy_grid_2d.h"
#include "stereovox/navmap/wall_faces.h"

namespace stereovox {

// Looks at each cell with a free cell before it and one behind it, on the opposite side, that is
// not free. Where it is known how far the surfaces seen from the free side reach into it
// (WallFaces::reach_m):
//   an occupied cell that they reach into by at most params.min_reach of its edge is free, and what
//   lies behind it is occupied; it is returned when they cross the border all the same. Both cells
//   stay where the same is seen from behind, of a thin wall on the border;
//   another cell with some evidence, before an occupied one, is occupied when they reach into it
//   farther, and unknown when they stay behind it by less than params.face_bias_m.
// Elsewhere an occupied cell is returned when the state of an occupied one behind it is higher by
// more than params.wall_contrast: what was measured in it may be the error of the surface behind.
//
// Cells that change take the state of their kind: of the free cell before, or of the occupied one.
//
// Returns the positions of cells that are free or occupied, nobody knows: they are labelled free
// until it is found what free space touches.
std::vector<std::size_t> thin_walls(OccupancyGrid2D& map, const WallFaces& faces,
                                    const NavmapParams& params);

}  // namespace stereovox
