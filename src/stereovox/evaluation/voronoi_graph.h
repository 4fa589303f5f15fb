// Ways midway between obstacles, as a graph on the cells of a map: a discrete generalised Voronoi
// diagram. Exact Voronoi edges (Fortune) are replaced by the cells where the nearest obstacle
// changes to one far from it (the integer medial axis of Hesselink and Roerdink 2008), thinned to
// lines one cell wide with the same topology.
#pragma once

#include <vector>

#include "stereovox/navmap/cell_mask.h"

namespace stereovox {

struct VoronoiGraph {
  CellMask lines;          // eight-connected
  std::vector<int> nodes;  // positions of junctions, ends and lone cells, ascending
};

// A cell is on a line when the robot can stand on it, it is at least c = max(robot radius, 1.5
// cells) from every occupied cell, and its nearest obstacle and that of a cell beside it are at
// least 2 c apart: so the cells of one wall make no lines among themselves.
VoronoiGraph voronoi_graph(const OccupancyGrid2D& map, double robot_radius_m);

}  // namespace stereovox
