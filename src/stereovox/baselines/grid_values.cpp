#include "stereovox/baselines/grid_values.h"

#include <algorithm>
#include <cmath>

namespace stereovox {
namespace {

constexpr double kUnknown = 0.5;

CellLabel label_of(double value) {
  if (value == kUnknown) return CellLabel::unknown;
  return value > kUnknown ? CellLabel::occupied : CellLabel::free;
}

}  // namespace

std::size_t cell_count(const GridGeometry& geometry) {
  return unknown_grid(geometry, "baseline").labels.size();
}

double probability_of(double log_odds) { return 1.0 / (1.0 + std::exp(-log_odds)); }
double log_odds_of(double probability) { return std::log(probability / (1.0 - probability)); }

OccupancyGrid2D grid_of_values(const GridGeometry& geometry, std::span<const double> values) {
  OccupancyGrid2D grid = unknown_grid(geometry, "baseline");
  for (std::size_t i = 0; i < values.size(); ++i) {
    grid.labels[i] = label_of(values[i]);
    grid.states[i] = static_cast<float>(values[i]);
  }
  return grid;
}

OccupancyGrid2D grid_of_log_odds(const GridGeometry& geometry, std::span<const double> log_odds) {
  std::vector<double> values(log_odds.size());
  std::ranges::transform(log_odds, values.begin(), probability_of);
  return grid_of_values(geometry, values);
}

}  // namespace stereovox
