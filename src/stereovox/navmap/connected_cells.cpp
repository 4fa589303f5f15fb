#include "stereovox/navmap/connected_cells.h"

#include <algorithm>

#include "stereovox/navmap/plan_path.h"

namespace stereovox {
namespace {

int grow_piece(const CellMask& mask, int seed, int number, std::vector<int>& piece_of) {
  std::vector<int> cells = {seed};
  piece_of[static_cast<std::size_t>(seed)] = number;
  for (std::size_t next = 0; next < cells.size(); ++next)
    for (int i = 0; i < kStraightMoves; ++i) {
      const Eigen::Vector2i neighbour =
          cell_in(mask.geometry, cells[next]) + Eigen::Vector2i(kMoves[i].dx, kMoves[i].dy);
      if (!mask.contains(neighbour)) continue;
      const int position = position_in(mask.geometry, neighbour);
      if (piece_of[static_cast<std::size_t>(position)] != kNoPiece) continue;
      piece_of[static_cast<std::size_t>(position)] = number;
      cells.push_back(position);
    }
  return static_cast<int>(cells.size());
}

CellMask piece(const CellMask& mask, const ConnectedCells& pieces, int number) {
  CellMask result = empty_mask(mask.geometry);
  for (std::size_t i = 0; i < result.cells.size(); ++i)
    result.cells[i] = pieces.piece_of[i] == number;
  return result;
}

}  // namespace

ConnectedCells connected_cells(const CellMask& mask) {
  ConnectedCells pieces{std::vector(mask.cells.size(), kNoPiece), {}};
  for (int i = 0; i < cell_count(mask.geometry); ++i)
    if (mask.has(i) && pieces.piece_of[static_cast<std::size_t>(i)] == kNoPiece)
      pieces.sizes.push_back(grow_piece(mask, i, pieces.count(), pieces.piece_of));
  return pieces;
}

CellMask largest_piece(const CellMask& mask) {
  const ConnectedCells pieces = connected_cells(mask);
  if (pieces.count() == 0) return empty_mask(mask.geometry);
  const auto largest = std::ranges::max_element(pieces.sizes);
  return piece(mask, pieces, static_cast<int>(largest - pieces.sizes.begin()));
}

CellMask piece_around(const CellMask& mask, const Eigen::Vector2i& cell) {
  if (!mask.contains(cell)) return empty_mask(mask.geometry);
  const ConnectedCells pieces = connected_cells(mask);
  const int position = position_in(mask.geometry, cell);
  return piece(mask, pieces, pieces.piece_of[static_cast<std::size_t>(position)]);
}

}  // namespace stereovox
