#include "stereovox/navmap/draw_map.h"

#include "stereovox/navmap/map_canvas.h"

namespace stereovox {

cv::Mat3b draw_map(const OccupancyGrid2D& grid, std::span<const Eigen::Vector2d> robot_path_m) {
  // By label; occupied is the largest and so the most important.
  const cv::Vec3b colours[] = {kUnknownColour, kFreeColour, kOccupiedColour};
  std::vector<std::uint8_t> classes;
  for (const CellLabel label : grid.labels) classes.push_back(static_cast<std::uint8_t>(label));

  MapCanvas canvas(grid.geometry);
  canvas.draw_cells(classes, colours);
  canvas.draw_path(robot_path_m);
  canvas.draw_axes();
  canvas.add_to_legend(kOccupiedColour, "occupied");
  canvas.add_to_legend(kFreeColour, "free");
  canvas.add_to_legend(kUnknownColour, "unknown");
  if (!robot_path_m.empty()) canvas.add_path_ends_to_legend();
  canvas.draw_scale_bar();
  return canvas.picture();
}

}  // namespace stereovox
