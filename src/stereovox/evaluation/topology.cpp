#include "stereovox/evaluation/topology.h"

#include "stereovox/navmap/connected_cells.h"

namespace stereovox {
namespace {

// Four times what the 2 x 2 window with `corner` at its upper right adds to the Euler number of a
// region connected over edges (Gray, "Local properties of binary images in two dimensions", 1971).
int quadruple_share(const CellMask& mask, const Eigen::Vector2i& corner) {
  const bool here = mask.contains(corner);
  const bool left = mask.contains(corner - Eigen::Vector2i(1, 0));
  const bool below = mask.contains(corner - Eigen::Vector2i(0, 1));
  const bool across = mask.contains(corner - Eigen::Vector2i(1, 1));
  const int set = int{here} + int{left} + int{below} + int{across};
  const bool is_diagonal = set == 2 && here == across;
  return is_diagonal ? 2 : set == 1 ? 1 : set == 3 ? -1 : 0;
}

}  // namespace

Topology topology_of(const CellMask& cells) {
  int quadruple = 0;
  for (int y = 0; y <= cells.geometry.height; ++y)
    for (int x = 0; x <= cells.geometry.width; ++x) quadruple += quadruple_share(cells, {x, y});
  return {connected_cells(cells).count(), quadruple / 4};
}

}  // namespace stereovox
