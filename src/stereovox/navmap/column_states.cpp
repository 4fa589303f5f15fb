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

Layers layers_of(const VoxelMap& map, const NavmapParams& params) {
  if (params.column == ColumnRule::whole) return {-kMaxLayer, kMaxLayer};
  // The centre of layer z is at (z + 1/2) * voxel size.
  const auto layer_at = [&](double height_m) {
    return (map.floor_z_m() + height_m) / map.voxel_size_m() - 0.5;
  };
  return {to_layer(std::ceil(layer_at(params.min_height_m) - kLayerTolerance)),
          to_layer(std::floor(layer_at(params.max_height_m) + kLayerTolerance))};
}

void add_block(const VoxelBlock& block, const Layers& layers, int min_observations,
               ColumnTile& tile) {
  const int base_z = block.index.z() * kBlockSide;
  for (int z = 0; z < kBlockSide; ++z) {
    if (!layers.contains(base_z + z)) continue;
    for (int i = 0; i < kCellsPerTile; ++i) {
      const PackedVoxel& voxel =
          block.voxels.packed(static_cast<std::size_t>(z * kCellsPerTile + i));
      if (voxel.observations > 0 && voxel.observations >= min_observations)
        add_voxel(voxel.state, tile[static_cast<std::size_t>(i)]);
    }
  }
}

ColumnReader::ColumnReader(const VoxelMap& map, const NavmapParams& params)
    : map_(map), layers_(layers_of(map, params)), min_observations_(params.min_observations) {
  if (params.column == ColumnRule::band) {
    first_block_z_ = layers_.first >> kBlockSideLog2;
    last_block_z_ = layers_.last >> kBlockSideLog2;
    return;
  }
  const auto blocks = map.sorted_blocks();
  if (blocks.empty()) return;
  const auto block_z = [](const VoxelBlock* block) { return block->index.z(); };
  const auto [lowest, highest] = std::ranges::minmax_element(blocks, {}, block_z);
  first_block_z_ = block_z(*lowest);
  last_block_z_ = block_z(*highest);
}

ColumnTile ColumnReader::read(const TileIndex& index) const {
  ColumnTile tile;
  for (int z = first_block_z_; z <= last_block_z_; ++z)
    if (const VoxelBlock* const block = map_.find_block({index.first, index.second, z}))
      add_block(*block, layers_, min_observations_, tile);
  return tile;
}

}  // namespace stereovox
