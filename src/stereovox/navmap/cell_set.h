// A set of cells of the unbounded 2D lattice through the world's origin, in tiles of 8 x 8 cells
// that lie over the columns of voxel blocks.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "stereovox/occupancy/block_index.h"

namespace stereovox {

using TileIndex = std::pair<int, int>;  // (x, y) of a cell >> 3

inline constexpr int kCellsPerTile = kBlockSide * kBlockSide;

inline TileIndex tile_of(const Eigen::Vector2i& cell) {
  return {cell.x() >> kBlockSideLog2, cell.y() >> kBlockSideLog2};
}

inline int position_in_tile(const Eigen::Vector2i& cell) {
  constexpr int kInside = kBlockSide - 1;
  return (cell.x() & kInside) | (cell.y() & kInside) << kBlockSideLog2;
}

inline Eigen::Vector2i cell_at(const TileIndex& tile, int position) {
  return {tile.first * kBlockSide + position % kBlockSide,
          tile.second * kBlockSide + position / kBlockSide};
}

class CellSet {
 public:
  // One bit a cell, at position_in_tile; no tile is without a bit. Ordered, so that equal sets have
  // equal bytes.
  using Tiles = std::map<TileIndex, std::uint64_t>;

  bool contains(const Eigen::Vector2i& cell) const;
  void insert(const TileIndex& tile, std::uint64_t bits);
  void erase(const TileIndex& tile, std::uint64_t bits);
  const Tiles& tiles() const { return tiles_; }
  bool operator==(const CellSet&) const = default;

 private:
  Tiles tiles_;
};

// Calls visit(cell) for each cell, tile by tile.
template <class Visit>
void for_each_cell(const CellSet& set, const Visit& visit) {
  for (const auto& [tile, bits] : set.tiles())
    for (int i = 0; i < kCellsPerTile; ++i)
      if (bits >> i & 1U) visit(cell_at(tile, i));
}

// Little-endian: u32 number of tiles, then i32 x, i32 y, u64 bits of each, in order.
void append_bytes(const CellSet& set, std::string& bytes);

// Takes a set off the front of `bytes`. Throws Error "<source>: ..." when it is cut off or not as
// append_bytes writes it.
CellSet take_cell_set(std::string_view& bytes, const std::string& source);

}  // namespace stereovox
