#include "stereovox/navmap/connected_cells.h"

#include <gtest/gtest.h>

#include "stereovox/navmap/drawn_map_for_test.h"

namespace stereovox {
namespace {

CellMask free_cells(const Drawing& drawing) {
  return cells_labelled(drawn_grid(drawing), CellLabel::free);
}

TEST(ConnectedCells, PiecesHangTogetherOverEdgesNotOverCorners) {
  const ConnectedCells pieces = connected_cells(free_cells({"..#..",  //
                                                            "..#.#",  //
                                                            "##.##"}));
  EXPECT_EQ(pieces.sizes, (std::vector{1, 4, 3}));
  EXPECT_EQ(pieces.piece_of[0], kNoPiece);
}

TEST(ConnectedCells, TheLargestPieceAndTheOneAroundACellCanBeTaken) {
  const CellMask free = free_cells({"...#."});
  EXPECT_EQ(largest_piece(free).cells, free_cells({"...##"}).cells);
  EXPECT_EQ(piece_around(free, {4, 0}).cells, free_cells({"####."}).cells);
  EXPECT_EQ(piece_around(free, {3, 0}).cells, empty_mask(free.geometry).cells);
  EXPECT_EQ(piece_around(free, {9, 9}).cells, empty_mask(free.geometry).cells);
}

}  // namespace
}  // namespace stereovox
