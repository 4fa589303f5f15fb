// The errors of a map on paths along its Voronoi graph (method.md, B.5, PA-2), which is how the
// tool behind the published figures very probably planned.
#pragma once

#include <cstdint>
#include <optional>

#include "stereovox/evaluation/ideal_map.h"

namespace stereovox {

struct VoronoiScoreParams {
  double robot_radius_m = 0.22;
  int max_pairs = 5000;  // of nodes; when there are more, so many are drawn by chance
  std::uint64_t seed = 1;
  int threads = 1;
};

struct VoronoiCounts {
  int nodes = 0;
  std::int64_t paths = 0;    // of the pairs, those that the graph joins
  std::int64_t invalid = 0;  // of them, those that the other map refuses
  std::optional<double> invalid_percent() const;
};

struct VoronoiScore {
  // Paths of the generated graph that come nearer than the radius to an obstacle of the ideal map.
  VoronoiCounts false_positive;
  // Paths of the ideal graph on which the generated map has an obstacle as near, or unknown cells.
  VoronoiCounts false_negative;
};

VoronoiScore score_voronoi_paths(const IdealMap& ideal, const OccupancyGrid2D& generated,
                                 const VoronoiScoreParams& params);

}  // namespace stereovox
