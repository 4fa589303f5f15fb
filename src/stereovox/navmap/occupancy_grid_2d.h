// The 2D navigation map. Cells are half-open squares of the world's x-y plane.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "stereovox/core/grid_geometry.h"

namespace stereovox {

enum class CellLabel : std::uint8_t { unknown, free, occupied };

// Both lists are row-major from cell (0, 0), row 0 at the smallest y, and hold width * height
// cells.
struct OccupancyGrid2D {
  GridGeometry geometry;
  std::vector<CellLabel> labels;
  std::vector<float> states;  // S(C) in [0, 1] (eq. 18); meaningless where the label is unknown

  std::size_t position_of(const Eigen::Vector2i& cell) const {
    return static_cast<std::size_t>(cell.y()) * static_cast<std::size_t>(geometry.width) +
           static_cast<std::size_t>(cell.x());
  }
  CellLabel label_at(const Eigen::Vector2i& cell) const { return labels[position_of(cell)]; }
};

// More cells than this are refused wherever a grid is made or read: 8000 x 8000, which is 400 m x
// 400 m at 5 cm, and as large an image as io/image_file.h reads.
inline constexpr std::int64_t kMaxCells = 64'000'000;

// A grid of unknown cells. Throws Error "<source>: ..." when it has no cells or too many.
OccupancyGrid2D unknown_grid(const GridGeometry& geometry, const std::string& source);

}  // namespace stereovox
