#include "stereovox/evaluation/obstacle_distance.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "stereovox/navmap/distance_field.h"

namespace stereovox {
namespace {

// Distances from the cells of `from` to the nearest of `to`, ascending.
std::vector<double> sorted_distances(const CellMask& from, const CellMask& to) {
  const DistanceField2D field = distance_field(to);
  std::vector<double> distances_m;
  for (std::size_t i = 0; i < from.cells.size(); ++i)
    if (from.cells[i] != 0) distances_m.push_back(field.distance_m[i]);
  std::ranges::sort(distances_m);
  return distances_m;
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// The smallest value that 95 % of them do not exceed.
double quantile95(const std::vector<double>& sorted) {
  const double rank = std::ceil(0.95 * static_cast<double>(sorted.size()));
  return sorted[static_cast<std::size_t>(rank) - 1];
}

}  // namespace

ObstacleDistance score_obstacle_distance(const IdealMap& ideal, const OccupancyGrid2D& generated) {
  const CellMask visible_walls = cells_labelled(ideal.normalised, CellLabel::occupied);
  const CellMask all_walls = cells_labelled(ideal.theoretical, CellLabel::occupied);
  const CellMask found = cells_labelled(generated, CellLabel::occupied);
  const std::vector<double> missing_m = sorted_distances(visible_walls, found);
  const std::vector<double> invented_m = sorted_distances(found, all_walls);
  if (missing_m.empty() || invented_m.empty()) return {};
  return {.to_generated_m = mean(missing_m),
          .to_ideal_m = mean(invented_m),
          .chamfer_m = mean(missing_m) + mean(invented_m),
          .hausdorff95_m = std::max(quantile95(missing_m), quantile95(invented_m))};
}

}  // namespace stereovox
