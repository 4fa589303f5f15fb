// How the paradigms' numbers become a map.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "stereovox/navmap/occupancy_grid_2d.h"

namespace stereovox {

// Number of cells. Throws Error when the grid has none or more than kMaxCells.
std::size_t cell_count(const GridGeometry& geometry);

double probability_of(double log_odds);
double log_odds_of(double probability);

// From one value in [0, 1] per cell: above one half occupied, below free, one half unknown.
OccupancyGrid2D grid_of_values(const GridGeometry& geometry, std::span<const double> values);

// From log-odds; 0 is unknown.
OccupancyGrid2D grid_of_log_odds(const GridGeometry& geometry, std::span<const double> log_odds);

}  // namespace stereovox
