#include "stereovox/baselines/thrun_1993.h"

#include <algorithm>
#include <vector>

#include "stereovox/baselines/grid_values.h"

namespace stereovox {
namespace {

// Calls visit(cell) for the cells of the grid in the square around the scan that holds its reach.
template <class Visit>
void for_each_cell_in_reach(const GridGeometry& geometry, const PseudoScan& scan,
                            double max_range_m, const Visit& visit) {
  const Eigen::Vector2d reach_m = Eigen::Vector2d::Constant(max_range_m);
  const Eigen::Vector2i first =
      index_of(geometry, scan.position_m - reach_m).cwiseMax(Eigen::Vector2i::Zero());
  const Eigen::Vector2i last =
      index_of(geometry, scan.position_m + reach_m)
          .cwiseMin(Eigen::Vector2i(geometry.width - 1, geometry.height - 1));
  for (int y = first.y(); y <= last.y(); ++y)
    for (int x = first.x(); x <= last.x(); ++x) visit(Eigen::Vector2i(x, y));
}

}  // namespace

void Thrun1993Params::describe(ParameterList& list) {
  list("max_range_m", max_range_m, {0.5, 100}, "reach of the network, as it was trained");
  list("prior", prior, {0.01, 0.99}, "P0: answer of the network that changes nothing");
  list("min_probability", min_probability, {0.001, 0.5}, "answers stay this far from 0 and 1");
  list("max_log_odds", max_log_odds, {1, 700}, "log-odds stay within this");
}

OccupancyGrid2D build_map(std::span<const PseudoScan> scans, const GridGeometry& geometry,
                          const Thrun1993Params& params, const ScanNetwork& network) {
  OccupancyGrid2D grid = unknown_grid(geometry, "thrun_1993");
  std::vector<double> log_odds(grid.labels.size(), 0.0);
  const double prior_log_odds = log_odds_of(params.prior);
  for (const PseudoScan& scan : scans)
    for_each_cell_in_reach(geometry, scan, params.max_range_m, [&](const Eigen::Vector2i& cell) {
      const auto features =
          features_of(scan, center_of(geometry, cell), geometry.cell_size_m, params.max_range_m);
      if (!features) return;
      const double p = std::clamp(occupancy(network, *features), params.min_probability,
                                  1.0 - params.min_probability);
      double& sum = log_odds[grid.position_of(cell)];
      sum = std::clamp(sum + log_odds_of(p) - prior_log_odds, -params.max_log_odds,
                       params.max_log_odds);
    });
  return grid_of_log_odds(geometry, log_odds);
}

OccupancyGrid2D build_map(std::span<const PseudoScan> scans, const GridGeometry& geometry,
                          const Thrun1993Params& params) {
  return build_map(scans, geometry, params, default_scan_network());
}

}  // namespace stereovox
