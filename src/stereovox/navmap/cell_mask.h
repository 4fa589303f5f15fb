// A set of cells of one bounded grid, for algorithms on maps. (CellSet is its unbounded kin.)
#pragma once

#include <cstdint>
#include <vector>

#include "stereovox/navmap/occupancy_grid_2d.h"

namespace stereovox {

inline constexpr int kNoCell = -1;

// Positions in row-major lists of the grid's cells; a grid has at most kMaxCells, which is an int.
inline int position_in(const GridGeometry& grid, const Eigen::Vector2i& cell) {
  return cell.y() * grid.width + cell.x();
}
inline Eigen::Vector2i cell_in(const GridGeometry& grid, int position) {
  return {position % grid.width, position / grid.width};
}
inline int cell_count(const GridGeometry& grid) { return grid.width * grid.height; }

struct CellMask {
  GridGeometry geometry;
  std::vector<std::uint8_t> cells;  // row-major from cell (0, 0); 1 = belongs to the set

  bool has(int position) const { return cells[static_cast<std::size_t>(position)] != 0; }
  // False outside the grid.
  bool contains(const Eigen::Vector2i& cell) const {
    return geometry.contains(cell) && has(position_in(geometry, cell));
  }
  void set(int position, bool is_in = true) {
    cells[static_cast<std::size_t>(position)] = is_in ? 1 : 0;
  }
};

inline CellMask empty_mask(const GridGeometry& grid) {
  return {grid, std::vector<std::uint8_t>(static_cast<std::size_t>(cell_count(grid)), 0)};
}

inline CellMask cells_labelled(const OccupancyGrid2D& grid, CellLabel label) {
  CellMask mask = empty_mask(grid.geometry);
  for (std::size_t i = 0; i < grid.labels.size(); ++i) mask.cells[i] = grid.labels[i] == label;
  return mask;
}

}  // namespace stereovox
