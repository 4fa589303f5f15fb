#include "stereovox/navmap/occupancy_grid_2d.h"

#include <fmt/format.h>

#include "stereovox/core/error.h"

namespace stereovox {

OccupancyGrid2D unknown_grid(const GridGeometry& geometry, const std::string& source) {
  const std::int64_t cells = std::int64_t{geometry.width} * geometry.height;
  if (geometry.width < 1 || geometry.height < 1 || cells > kMaxCells)
    throw Error(fmt::format("{}: a map of {} x {} cells of {:.6g} m is not between 1 and {} cells",
                            source, geometry.width, geometry.height, geometry.cell_size_m,
                            kMaxCells));
  const auto count = static_cast<std::size_t>(cells);
  return {geometry, std::vector(count, CellLabel::unknown), std::vector(count, 0.0F)};
}

}  // namespace stereovox
