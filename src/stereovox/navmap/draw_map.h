// The map as a picture for people: colours with a legend, axes in metres, a scale bar, the way of
// the robot. For programs there is write_map_server.h.
#pragma once

#include <opencv2/core/mat.hpp>
#include <span>

#include "stereovox/navmap/occupancy_grid_2d.h"

namespace stereovox {

// BGR. Small maps are magnified to about 900 pixels; of maps over 3000 cells a side, several cells
// share a pixel, which shows the most important of them (occupied, then free). x points right, y
// up. The way is drawn over the map from a green disc to a red square; it may be empty and may
// leave the map.
cv::Mat3b draw_map(const OccupancyGrid2D& grid, std::span<const Eigen::Vector2d> robot_path_m);

}  // namespace stereovox
