// The pieces of a set of cells that hang together over their edges.
#pragma once

#include <vector>

#include "stereovox/navmap/cell_mask.h"

namespace stereovox {

struct ConnectedCells {
  std::vector<int> piece_of;  // by position; kNoPiece outside the set
  std::vector<int> sizes;     // cells of each piece; pieces are numbered by their first position

  int count() const { return static_cast<int>(sizes.size()); }
};
inline constexpr int kNoPiece = -1;

ConnectedCells connected_cells(const CellMask& mask);

// The largest piece, of several the first; empty when the set is.
CellMask largest_piece(const CellMask& mask);

// The piece that holds `cell`; empty when the set does not.
CellMask piece_around(const CellMask& mask, const Eigen::Vector2i& cell);

}  // namespace stereovox
