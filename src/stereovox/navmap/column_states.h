// What the voxels above a cell say about it (eqs. 17, 18): S(C) = max over the column of S(V).
// Computed for the 64 cells above which one column of voxel blocks stands.
#pragma once

#include <array>
#include <map>
#include <optional>

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

// Calls visit(tile index, ColumnTile) for every column of blocks of the map, in canonical order but
// for columns of the same map tile in x, which come by its y first.
template <class Visit>
void for_each_column_tile(const VoxelMap& map, const NavmapParams& params, const Visit& visit) {
  const Layers layers = layers_of(map, params);
  std::map<TileIndex, ColumnTile> columns;  // of the map tiles above each other
  std::optional<Eigen::Vector2i> place;
  const auto finish = [&] {
    for (const auto& [index, column] : columns) visit(index, column);
    columns.clear();
  };
  map.for_each_tile([&](const Eigen::Vector3i& tile, std::span<const VoxelBlock* const> blocks) {
    if (place && *place != tile.head<2>()) finish();
    place = tile.head<2>();
    for (const VoxelBlock* const block : blocks)
      add_block(*block, layers, params.min_observations,
                columns[{block->index.x(), block->index.y()}]);
  });
  finish();
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
