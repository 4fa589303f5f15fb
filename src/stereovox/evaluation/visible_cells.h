// Which cells of a plan a camera could have seen, so that a map is not blamed for rooms that the
// robot did not visit (N_vis of method.md, B.4).
#pragma once

#include <span>

#include "stereovox/navmap/cell_mask.h"

namespace stereovox {

struct ViewPose {
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
  double heading_rad = 0;  // of the optical axis, from the x axis towards the y axis
};

// Cells that a ray of some pose crosses within `max_range_m`, up to and including the first
// occupied one; unknown cells of the plan do not stop a ray. Rays are at most half a cell apart.
// Poses outside the plan see nothing. Throws UsageError unless 0 < fov_rad <= 2 pi and the range
// is in (0, 1000] m.
CellMask visible_cells(const OccupancyGrid2D& plan, std::span<const ViewPose> poses, double fov_rad,
                       double max_range_m);

}  // namespace stereovox
