#include "stereovox/navmap/hidden_cells.h"

#include <algorithm>
#include <cmath>

#include "stereovox/navmap/connected_cells.h"

namespace stereovox {
namespace {

// The band of uncertain cells before a wall is about as wide whatever the size of the cells.
constexpr double kReach_m = 0.25;

int reach_in_cells(double cell_size_m) {
  return std::max(1, static_cast<int>(std::lround(kReach_m / cell_size_m)));
}

bool is_near(const CellMask& mask, const Eigen::Vector2i& cell, int reach) {
  for (int dy = -reach; dy <= reach; ++dy)
    for (int dx = -reach; dx <= reach; ++dx)
      if (mask.contains(cell + Eigen::Vector2i(dx, dy))) return true;
  return false;
}

}  // namespace

void forget_hidden_cells(OccupancyGrid2D& map) {
  const CellMask reached = largest_piece(cells_labelled(map, CellLabel::free));
  const int reach = reach_in_cells(map.geometry.cell_size_m);
  for (int i = 0; i < cell_count(map.geometry); ++i) {
    CellLabel& label = map.labels[static_cast<std::size_t>(i)];
    if (label == CellLabel::unknown) continue;
    const bool is_visible = label == CellLabel::free
                                ? reached.has(i)
                                : is_near(reached, cell_in(map.geometry, i), reach);
    if (!is_visible) label = CellLabel::unknown;
  }
}

}  // namespace stereovox
