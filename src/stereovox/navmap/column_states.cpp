#include "stereovox/navmap/column_states.h"

#include <algorithm>
#include <cmath>

namespace stereovox {
namespace {

// A voxel centre exactly on the end of the band belongs to it, whatever the rounding.
constexpr double kLayerTolerance = 1e-6;
constexpr int kMaxLayer = (kMaxBlockCoordinate + 1) * kBlockSide - 1;

int to_layer(double z) {
  return static_cast<int>(std::clamp(z, -1.0 * kMaxLayer, 1.0 * kMaxLayer));
}

void add_voxel(float state, ColumnState& column) {
  column.max_state = column.is_known ? std::max(column.max_state, state) : state;
  column.is_known = true;
}

}  // namespace

ColumnLayers::ColumnLayers(const VoxelMap& map, const NavmapParams& params)
    : map_(map),
      params_(params),
      floor_(map.floor),
      is_same_everywhere_(params.column == ColumnRule::whole || map.floor.is_level()),
      everywhere_(over_floor(map.floor_z_m())) {}

Layers ColumnLayers::over_floor(double floor_z_m) const {
  if (params_.column == ColumnRule::whole) return {-kMaxLayer, kMaxLayer};
  // The centre of layer z is at (z + 1/2) * voxel size.
  const auto layer_at = [&](double height_m) {
    return (floor_z_m + height_m) / map_.voxel_size_m() - 0.5;
  };
  return {to_layer(std::ceil(layer_at(params_.min_height_m) - kLayerTolerance)),
          to_layer(std::floor(layer_at(params_.max_height_m) + kLayerTolerance))};
}

Layers ColumnLayers::above(const Eigen::Vector2i& cell) {
  if (is_same_everywhere_) return everywhere_;
  return of(tile_of(cell))[static_cast<std::size_t>(position_in_tile(cell))];
}

Layers ColumnLayers::above_tile(const TileIndex& index) {
  if (is_same_everywhere_) return everywhere_;
  const Tile& tile = of(index);
  return {std::ranges::min_element(tile, {}, &Layers::first)->first,
          std::ranges::max_element(tile, {}, &Layers::last)->last};
}

const ColumnLayers::Tile& ColumnLayers::of(const TileIndex& index) {
  const auto [found, is_new] = tiles_.try_emplace(index);
  Tile& tile = found->second;
  for (int i = 0; is_new && i < kCellsPerTile; ++i) {
    const Eigen::Vector2d center = cell_at(index, i).cast<double>().array() + 0.5;
    tile[static_cast<std::size_t>(i)] = over_floor(floor_.z_m(center * map_.voxel_size_m()));
  }
  return tile;
}

void ColumnLayers::add_block(const VoxelBlock& block, int min_observations, ColumnTile& tile) {
  const TileIndex index(block.index.x(), block.index.y());
  const Tile* const limits = is_same_everywhere_ ? nullptr : &of(index);
  const Layers layers = above_tile(index);
  const int base_z = block.index.z() * kBlockSide;
  for (int z = 0; z < kBlockSide; ++z)
    if (layers.contains(base_z + z)) add_layer(block, z, limits, min_observations, tile);
}

// `limits`: of each cell; nullptr: the layer counts above all of them.
void ColumnLayers::add_layer(const VoxelBlock& block, int z, const Tile* limits,
                             int min_observations, ColumnTile& tile) const {
  const int layer = block.index.z() * kBlockSide + z;
  for (int i = 0; i < kCellsPerTile; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (limits != nullptr && !(*limits)[at].contains(layer)) continue;
    const PackedVoxel& voxel = block.voxels.packed(static_cast<std::size_t>(z * kCellsPerTile + i));
    if (voxel.observations > 0 && voxel.observations >= min_observations)
      add_voxel(voxel.state, tile[at]);
  }
}

ColumnReader::ColumnReader(const VoxelMap& map, const NavmapParams& params)
    : map_(map), layers_(map, params), min_observations_(params.min_observations) {
  if (params.column == ColumnRule::band) return;
  const auto blocks = map.sorted_blocks();
  const auto block_z = [](const VoxelBlock* block) { return block->index.z(); };
  const auto [lowest, highest] = std::ranges::minmax_element(blocks, {}, block_z);
  blocks_ = blocks.empty() ? Layers{0, -1} : Layers{block_z(*lowest), block_z(*highest)};
}

ColumnTile ColumnReader::read(const TileIndex& index) {
  const auto needed = [&] {
    const Layers layers = layers_.above_tile(index);
    return Layers{layers.first >> kBlockSideLog2, layers.last >> kBlockSideLog2};
  };
  const Layers blocks = blocks_ ? *blocks_ : needed();
  ColumnTile tile;
  for (int z = blocks.first; z <= blocks.last; ++z)
    if (const VoxelBlock* const block = map_.find_block({index.first, index.second, z}))
      layers_.add_block(*block, min_observations_, tile);
  return tile;
}

}  // namespace stereovox
