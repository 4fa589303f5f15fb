// How far the obstacles of a map lie from the true ones, between cell centres.
#pragma once

#include <optional>

#include "stereovox/evaluation/ideal_map.h"

namespace stereovox {

// Absent when one of the maps has no obstacle.
struct ObstacleDistance {
  // Mean distance from each occupied cell of the normalised ideal map to the nearest occupied one
  // of the generated map ("NE" of public map evaluation scripts): grows with what is missing.
  std::optional<double> to_generated_m;
  // And from each occupied generated cell to the nearest occupied cell of the plan: grows with what
  // was invented.
  std::optional<double> to_ideal_m;
  std::optional<double> chamfer_m;      // sum of both
  std::optional<double> hausdorff95_m;  // the larger of both 95 % quantiles
};

// Both maps are of one geometry.
ObstacleDistance score_obstacle_distance(const IdealMap& ideal, const OccupancyGrid2D& generated);

}  // namespace stereovox
