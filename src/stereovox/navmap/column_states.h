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

// The layers above each cell whose voxel centres lie in the band over the floor there, or all
// layers that can exist. Refers to the map, whose floor must not change.
class ColumnLayers {
 public:
  ColumnLayers(const VoxelMap& map, const NavmapParams& params);

  Layers above(const Eigen::Vector2i& cell);
  // From the lowest to the highest layer above a tile of cells.
  Layers above_tile(const TileIndex& index);
  // Takes the voxels of one more block into account.
  void add_block(const VoxelBlock& block, int min_observations, ColumnTile& tile);

 private:
  using Tile = std::array<Layers, kCellsPerTile>;

  Layers over_floor(double floor_z_m) const;
  const Tile& of(const TileIndex& index);
  void add_layer(const VoxelBlock& block, int z, const Tile* limits, int min_observations,
                 ColumnTile& tile) const;

  const VoxelMap& map_;
  const NavmapParams& params_;
  FloorReader floor_;
  bool is_same_everywhere_;
  Layers everywhere_;
  std::map<TileIndex, Tile> tiles_;  // that were asked for, where the floor is not level
};

// Calls visit(tile index, ColumnTile) for every column of blocks of the map, in canonical order but
// for columns of the same map tile in x, which come by its y first.
template <class Visit>
void for_each_column_tile(const VoxelMap& map, const NavmapParams& params, const Visit& visit) {
  ColumnLayers layers(map, params);
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
      layers.add_block(*block, params.min_observations,
                       columns[{block->index.x(), block->index.y()}]);
  });
  finish();
}

// Finds single tiles quickly; refers to the map.
class ColumnReader {
 public:
  ColumnReader(const VoxelMap& map, const NavmapParams& params);
  ColumnTile read(const TileIndex& index);

 private:
  const VoxelMap& map_;
  ColumnLayers layers_;
  int min_observations_;
  std::optional<Layers> blocks_;  // along z; nothing: those that the layers need
};

}  // namespace stereovox
