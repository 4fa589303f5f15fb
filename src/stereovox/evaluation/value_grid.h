// Maps as numbers, for figures that compare them cell by cell, and the ground on which two maps
// meet: the same lattice and the union of their extents.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "stereovox/navmap/occupancy_grid_2d.h"

namespace stereovox {

enum class MapForm {
  ternary,  // occupied 1, free 0
  graded,   // the state of each known cell
};
std::span<const std::string> names_of(MapForm);

inline constexpr double kUnknownValue = 0.5;

// Occupancy in [0, 1], row-major from cell (0, 0); unknown cells have kUnknownValue.
struct ValueGrid {
  GridGeometry geometry;
  std::vector<double> values;
};

ValueGrid value_grid(const OccupancyGrid2D& map, MapForm form);

// Where cell (0, 0) of `b` lies in the cells of `a`. Throws Error, with the numbers, when the cell
// sizes differ by more than 1e-6 of their size, or the origins by other than whole cells (to within
// 1e-3 of a cell).
Eigen::Vector2i lattice_offset(const GridGeometry& a, const GridGeometry& b);

// The smallest grid on the lattice of `a` that holds both. Throws Error as lattice_offset, and when
// it has more than kMaxCells.
GridGeometry union_of(const GridGeometry& a, const GridGeometry& b);

// The map on another extent of its lattice; cells beyond the map are unknown.
OccupancyGrid2D extended_to(const OccupancyGrid2D& map, const GridGeometry& region);

// Up to the rounding of files.
bool have_same_cell_size(const GridGeometry& a, const GridGeometry& b);

// The map on the lattice of `lattice`, over the map's own extent: each cell is that of the map in
// which its centre lies.
OccupancyGrid2D resampled_to(const OccupancyGrid2D& map, const GridGeometry& lattice);

}  // namespace stereovox
