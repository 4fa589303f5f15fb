// The cells of a 2D grid that a beam crosses, in order, none left out (Amanatides & Woo 1987). The
// one traversal that all paradigms share.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "stereovox/core/grid_geometry.h"

namespace stereovox {

struct Ray2D {
  Eigen::Vector2d origin_m;
  double direction_rad = 0;  // from the grid's x axis, counter-clockwise
};

struct BeamCell {
  Eigen::Vector2i cell;
  std::size_t position = 0;  // of the cell in row-major lists
  double enter_m = 0;        // where the ray enters the cell
  double distance_m = 0;     // of the cell's centre along the ray; below 0 only in the first cell
};

// Calls visit(BeamCell) for each cell of the grid that the ray enters before `length_m`, nearest
// first; the ray may begin outside the grid. distance_m never falls from one cell to the next.
template <class Visit>
void for_each_beam_cell(const GridGeometry& grid, const Ray2D& ray, double length_m,
                        const Visit& visit) {
  const Eigen::Vector2d direction(std::cos(ray.direction_rad), std::sin(ray.direction_rad));
  Eigen::Vector2i cell = index_of(grid, ray.origin_m);
  const Eigen::Vector2i step(direction.x() < 0.0 ? -1 : 1, direction.y() < 0.0 ? -1 : 1);
  const Eigen::Vector2d to_center_m = center_of(grid, cell) - ray.origin_m;
  std::array<double, 2> next_m{}, pitch_m{};  // along the ray, to the next border of each axis
  for (int axis = 0; axis < 2; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    pitch_m[i] = direction[axis] == 0.0 ? std::numeric_limits<double>::infinity()
                                        : grid.cell_size_m / std::abs(direction[axis]);
    const double to_border_m = to_center_m[axis] + 0.5 * step[axis] * grid.cell_size_m;
    next_m[i] = direction[axis] == 0.0 ? pitch_m[i] : to_border_m / direction[axis];
  }
  for (double enter_m = 0.0; enter_m < length_m;) {
    if (grid.contains(cell)) {
      const double distance_m = (center_of(grid, cell) - ray.origin_m).dot(direction);
      const auto position =
          static_cast<std::size_t>(cell.y()) * static_cast<std::size_t>(grid.width) +
          static_cast<std::size_t>(cell.x());
      visit(BeamCell{cell, position, enter_m, distance_m});
    }
    const int axis = next_m[0] <= next_m[1] ? 0 : 1;
    enter_m = next_m[static_cast<std::size_t>(axis)];
    next_m[static_cast<std::size_t>(axis)] += pitch_m[static_cast<std::size_t>(axis)];
    cell[axis] += step[axis];
  }
}

}  // namespace stereovox
