// The 3D map seen from above (eqs. 17, 18): every cell is unknown, free or occupied.
#pragma once

#include "stereovox/navmap/occupancy_grid_2d.h"
#include "stereovox/navmap/sight_lines.h"
#include "stereovox/navmap/wall_faces.h"

namespace stereovox {

// A cell is occupied when S(C), the largest state of its column, is above the threshold. It is free
//   visible:    when S(C) is below free_threshold, or it was on a line of sight;
//   as_printed: when it was on a line of sight;
// and is not occupied. All else is unknown, and hidden cells if the parameters say so. The label
// depends on the states as they are now, so an occupied cell whose state drops is occupied no
// longer. Where the evidence for a surface is spread over two layers of cells, `faces` tell in
// which it lies (thin_walls.h).
//
// The grid holds the known voxels of the column rule and the cells on lines of sight; its origin is
// a multiple of the cell size. From an empty map comes one unknown cell. Throws Error when the map
// stretches over more than kMaxCells, UsageError when the height band is upside down.
OccupancyGrid2D project_to_2d(const VoxelMap& map, const SightLines& sight_lines,
                              const NavmapParams& params, const WallFaces& faces = {});

}  // namespace stereovox
