#include "stereovox/navmap/thin_walls.h"

#include <array>

#include "stereovox/core/grid_geometry.h"

namespace stereovox {
namespace {

bool is_inside(const GridGeometry& geometry, const Eigen::Vector2i& cell) {
  return cell.x() >= 0 && cell.y() >= 0 && cell.x() < geometry.width && cell.y() < geometry.height;
}

// Whether `step` leads to free space, and away from it lies stronger evidence.
bool is_spread(const OccupancyGrid2D& map, const Eigen::Vector2i& cell, const Eigen::Vector2i& step,
               double contrast) {
  const Eigen::Vector2i before = cell + step, behind = cell - step;
  if (!is_inside(map.geometry, before) || !is_inside(map.geometry, behind)) return false;
  return map.label_at(before) == CellLabel::free && map.label_at(behind) == CellLabel::occupied &&
         map.states[map.position_of(behind)] > map.states[map.position_of(cell)] + contrast;
}

}  // namespace

void thin_walls(OccupancyGrid2D& map, double contrast) {
  static const std::array<Eigen::Vector2i, 4> kSteps = {
      Eigen::Vector2i(1, 0), Eigen::Vector2i(-1, 0), Eigen::Vector2i(0, 1), Eigen::Vector2i(0, -1)};
  std::vector<std::size_t> spread;
  for (int y = 0; y < map.geometry.height; ++y)
    for (int x = 0; x < map.geometry.width; ++x) {
      const Eigen::Vector2i cell(x, y);
      if (map.label_at(cell) != CellLabel::occupied) continue;
      for (const Eigen::Vector2i& step : kSteps)
        if (is_spread(map, cell, step, contrast)) {
          spread.push_back(map.position_of(cell));
          break;
        }
    }
  for (const std::size_t position : spread) map.labels[position] = CellLabel::free;
}

}  // namespace stereovox
