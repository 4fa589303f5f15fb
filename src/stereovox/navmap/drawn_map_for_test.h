// Maps drawn as text, for tests: '#' occupied, '.' free, '?' unknown. The first line has the
// largest y, as on a map; the last line's first character is cell (0, 0).
#pragma once

#include <string>
#include <vector>

#include "stereovox/navmap/occupancy_grid_2d.h"
#include "stereovox/occupancy/voxel_map.h"

namespace stereovox {

inline constexpr double kDrawnVoxelSize_m = 0.1;
inline constexpr int kDrawnLayer = 5;  // centre at 0.55 m, inside the default height band
inline constexpr float kOccupiedState = 0.9F, kFreeState = 0.1F;
inline constexpr std::uint16_t kOftenObserved = 5;

using Drawing = std::vector<std::string>;

inline void set_voxel(VoxelMap& map, const Eigen::Vector3i& voxel, float state,
                      std::uint16_t observations = kOftenObserved) {
  map.set(voxel, {.state = state, .observations = observations});
}

// Calls visit(cell, character) for each character.
template <class Visit>
void for_each_drawn(const Drawing& drawing, const Visit& visit) {
  const int rows = static_cast<int>(drawing.size());
  for (int row = 0; row < rows; ++row) {
    const std::string& line = drawing[static_cast<std::size_t>(row)];
    for (int x = 0; x < static_cast<int>(line.size()); ++x)
      visit(Eigen::Vector2i(x, rows - 1 - row), line[static_cast<std::size_t>(x)]);
  }
}

// One layer of voxels at the heights of the robot.
inline VoxelMap drawn_voxels(const Drawing& drawing) {
  VoxelMap map(kDrawnVoxelSize_m);
  for_each_drawn(drawing, [&](const Eigen::Vector2i& cell, char c) {
    const Eigen::Vector3i voxel(cell.x(), cell.y(), kDrawnLayer);
    if (c == '#') set_voxel(map, voxel, kOccupiedState);
    if (c == '.') set_voxel(map, voxel, kFreeState);
  });
  return map;
}

inline OccupancyGrid2D drawn_grid(const Drawing& drawing, double cell_size_m = kDrawnVoxelSize_m,
                                  const Eigen::Vector2d& origin_m = {0, 0}) {
  const int width = static_cast<int>(drawing.front().size());
  const int height = static_cast<int>(drawing.size());
  OccupancyGrid2D grid = unknown_grid({origin_m, cell_size_m, width, height}, "drawing");
  for_each_drawn(drawing, [&](const Eigen::Vector2i& cell, char c) {
    const std::size_t position = grid.position_of(cell);
    if (c == '#') grid.labels[position] = CellLabel::occupied;
    if (c == '.') grid.labels[position] = CellLabel::free;
    grid.states[position] = c == '#' ? 1.0F : 0.0F;
  });
  return grid;
}

inline Drawing drawing_of(const OccupancyGrid2D& grid) {
  constexpr const char* kCharacters = "?.#";
  Drawing drawing;
  for (int y = grid.geometry.height - 1; y >= 0; --y) {
    std::string& line = drawing.emplace_back();
    for (int x = 0; x < grid.geometry.width; ++x)
      line += kCharacters[static_cast<int>(grid.label_at({x, y}))];
  }
  return drawing;
}

}  // namespace stereovox
