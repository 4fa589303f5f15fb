// The pictures of an experiment, as the paper has them.
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "stereovox/navmap/occupancy_grid_2d.h"

namespace stereovox {

struct TitledMap {
  std::string title;
  OccupancyGrid2D map;
};

// Maps side by side, each under its title: occupied black, free white, unknown grey, as the paper's
// figures 8 and 9. All are drawn at one scale, `columns` in a row.
cv::Mat3b draw_side_by_side(const std::vector<TitledMap>& maps, int columns);

}  // namespace stereovox
