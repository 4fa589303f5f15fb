// The occupied voxels as a picture for people: seen obliquely from above, coloured by height.
#pragma once

#include <opencv2/core/mat.hpp>

#include "stereovox/occupancy/voxel_map.h"

namespace stereovox {

struct VoxelView {
  double azimuth_deg = -120.0;  // where the viewer stands, counted from the world's x axis
  double elevation_deg = 50.0;  // 90 looks straight down
  int longest_side_px = 900;
  double threshold = 0.5;    // a voxel is drawn when its state is above this
  int min_observations = 3;  // ... and it was observed in at least so many frames
};

// BGR, parallel projection; white where nothing is occupied. Blue is the floor, red 2 m above it.
cv::Mat3b draw_voxels(const VoxelMap& map, const VoxelView& view = {});

}  // namespace stereovox
