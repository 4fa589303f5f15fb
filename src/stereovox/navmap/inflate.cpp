#include "stereovox/navmap/inflate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "stereovox/core/error.h"

namespace stereovox {
namespace {

constexpr double kMaxRadius_m = 100.0;
constexpr double kRounding = 1e-9;  // relative; a radius of whole and half cells reaches them

// Of one row of the disc: cells up to `reach` columns away are blocked.
struct DiscRow {
  int dy, reach;
};

std::vector<DiscRow> disc_rows(double radius_cells) {
  const auto is_inside = [&](int dx, int dy) {
    return std::hypot(std::max(std::abs(dx) - 0.5, 0.0), std::max(std::abs(dy) - 0.5, 0.0)) <=
           radius_cells * (1.0 + kRounding);
  };
  std::vector<DiscRow> rows;
  const int furthest = static_cast<int>(std::floor(radius_cells + 0.5 + kRounding));
  for (int dy = -furthest; dy <= furthest; ++dy) {
    int reach = furthest;
    while (reach >= 0 && !is_inside(reach, dy)) --reach;
    if (reach >= 0) rows.push_back({dy, reach});
  }
  return rows;
}

void occupy(const Eigen::Vector2i& center, const DiscRow& row, OccupancyGrid2D& map) {
  const int y = center.y() + row.dy;
  if (y < 0 || y >= map.geometry.height) return;
  const int first = std::max(center.x() - row.reach, 0);
  const int last = std::min(center.x() + row.reach, map.geometry.width - 1);
  const auto begin = static_cast<std::ptrdiff_t>(map.position_of({first, y}));
  std::fill_n(map.labels.begin() + begin, last - first + 1, CellLabel::occupied);
  std::fill_n(map.states.begin() + begin, last - first + 1, 1.0F);
}

}  // namespace

OccupancyGrid2D inflate(const OccupancyGrid2D& map, double radius_m) {
  if (!(radius_m >= 0.0 && radius_m <= kMaxRadius_m))
    throw UsageError(fmt::format("robot radius: {} is outside [0, {}] m", radius_m, kMaxRadius_m));
  const std::vector<DiscRow> disc = disc_rows(radius_m / map.geometry.cell_size_m);
  OccupancyGrid2D inflated = map;
  for (int y = 0; y < map.geometry.height; ++y)
    for (int x = 0; x < map.geometry.width; ++x) {
      if (map.label_at({x, y}) != CellLabel::occupied) continue;
      for (const DiscRow& row : disc) occupy({x, y}, row, inflated);
    }
  return inflated;
}

}  // namespace stereovox
