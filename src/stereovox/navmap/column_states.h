// What the voxels above a cell say about it (eqs. 17, 18): S(C) = max over the column of S(V).
// Computed for the 64 cells above which one column of voxel blocks stands.
#pragma once

#include <array>

#include "stereovox/navmap/cell_set.h"
#include "stereovox/navmap/navmap_params.h"
#include "stereovox/occupancy/voxel_map.h"

namespace stereovox {

// Over the voxels of the column that count: known often enough, and at the right height.
struct ColumnState {
  float max_state = 0;
  bool is_known = false;  // some voxel counts
};

using ColumnTile = std::array<ColumnState, kCellsPerTile>;

// Voxel layers that count, both included.
struct Layers {
  int first, last;

  bool contains(int z) const { return first <= z && z <= last; }
};

// The layers whose voxel centres lie in the band, or all layers that can exist.
Layers layers_of(const VoxelMap& map, const NavmapParams& params);

// Takes the voxels of one more block into account.
void add_block(const VoxelBlock& block, const Layers& layers, int min_observations,
               ColumnTile& tile);

// Calls visit(tile index, ColumnTile) for every column of blocks of the map, in canonical order.
template <class Visit>
void for_each_column_tile(const VoxelMap& map, const NavmapParams& params, const Visit& visit) {
  const Layers layers = layers_of(map, params);
  const std::vector<const VoxelBlock*> blocks = map.sorted_blocks();
  for (std::size_t i = 0; i < blocks.size();) {
    const TileIndex index(blocks[i]->index.x(), blocks[i]->index.y());
    ColumnTile tile;
    for (; i < blocks.size() && index == TileIndex(blocks[i]->index.x(), blocks[i]->index.y()); ++i)
      add_block(*blocks[i], layers, params.min_observations, tile);
    visit(index, tile);
  }
}

// Finds single tiles quickly; refers to the map.
class ColumnReader {
 public:
  ColumnReader(const VoxelMap& map, const NavmapParams& params);
  ColumnTile read(const TileIndex& index) const;

 private:
  const VoxelMap& map_;
  Layers layers_;
  int min_observations_;
  int first_block_z_ = 0, last_block_z_ = -1;
};

}  // namespace stereovox
