// The maps that a perfect sensor would make, from the geometry alone.
#pragma once

#include <cstdint>
#include <vector>

#include "stereovox/core/grid_geometry.h"
#include "stereovox/simulation/world.h"

namespace stereovox {

struct HeightBand {
  double min_m = 0.15, max_m = 1.5;
};

// Which cells something stands in, row-major from cell (0, 0).
struct OccupiedCells {
  GridGeometry geometry;
  std::vector<std::uint8_t> is_occupied;
};

// A solid counts for a cell (or voxel) when at least `kMinOverlap` of what could lie in one does:
// a wall whose face only grazes a cell does not, a thin leg between two cells counts for both.
inline constexpr double kMinOverlap = 0.1;

// Over the whole world, cell borders at multiples of the cell size (as the maps of the pipeline
// have them). People are left out. Throws UsageError for more than 64 million cells.
OccupiedCells occupied_cells(const World& world, double cell_size_m, const HeightBand& band);

// Which voxels something stands in, from `min` on; x runs fastest, then y, then z.
struct OccupiedVoxels {
  double voxel_size_m = 0.0;
  Eigen::Vector3i min, size;
  std::vector<std::uint8_t> is_occupied;

  std::size_t position_of(const Eigen::Vector3i& index) const {
    const Eigen::Vector3i i = index - min;
    return (static_cast<std::size_t>(i.z()) * static_cast<std::size_t>(size.y()) +
            static_cast<std::size_t>(i.y())) *
               static_cast<std::size_t>(size.x()) +
           static_cast<std::size_t>(i.x());
  }
};

// Between two heights over the whole world, floor included. Throws UsageError as above.
OccupiedVoxels occupied_voxels(const World& world, double voxel_size_m, const HeightBand& band);

}  // namespace stereovox
