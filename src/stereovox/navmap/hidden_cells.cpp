#include "stereovox/navmap/hidden_cells.h"

#include "stereovox/navmap/connected_cells.h"

namespace stereovox {
namespace {

bool touches(const CellMask& mask, const Eigen::Vector2i& cell) {
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx)
      if (mask.contains(cell + Eigen::Vector2i(dx, dy))) return true;
  return false;
}

}  // namespace

void forget_hidden_cells(OccupancyGrid2D& map) {
  const CellMask reached = largest_piece(cells_labelled(map, CellLabel::free));
  for (int i = 0; i < cell_count(map.geometry); ++i) {
    CellLabel& label = map.labels[static_cast<std::size_t>(i)];
    const bool is_visible =
        label == CellLabel::free ? reached.has(i) : touches(reached, cell_in(map.geometry, i));
    if (!is_visible) label = CellLabel::unknown;
  }
}

}  // namespace stereovox
