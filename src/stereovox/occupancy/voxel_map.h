// The 3D occupancy map: what is known of each voxel, in blocks of 8 x 8 x 8 that exist only where
// something was observed. It stores and finds; how measurements change it is integrate.h's
// business.
//
//   map.for_each_block([&](const VoxelBlock& block) {
//     for (int i = 0; i < kVoxelsPerBlock; ++i)
//       if (is_known(block.voxels[i])) use(voxel_at(block.index, i), block.voxels[i]);
//   });
//
// With a tile store a map may be larger than memory: keep_within() writes the tiles that changed
// longest ago to the store, and whoever asks for one of their blocks has the tile read back. So the
// map always answers the same, but then even readers must take turns.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "stereovox/occupancy/floor_surface.h"
#include "stereovox/occupancy/tile_table.h"

namespace stereovox {

struct VoxelBounds {
  Eigen::Vector3i min, max;  // voxel indices, both included

  bool contains(const Eigen::Vector3i& voxel) const {
    return (voxel.array() >= min.array()).all() && (voxel.array() <= max.array()).all();
  }
};

// Voxel i covers [i, i + 1) * voxel_size_m along each axis of the world. Blocks keep their address
// while their tile is in memory.
class VoxelMap {
 public:
  // The floor belongs to the map because height limits count from it. Throws Error
  // when the size is not in [0.001, 10] m or the height is not finite.
  explicit VoxelMap(double voxel_size_m, double floor_z_m = 0.0);
  // A copy has no store: it holds everything in memory.
  VoxelMap(const VoxelMap& other);
  VoxelMap& operator=(const VoxelMap& other);
  VoxelMap(VoxelMap&&) = default;
  VoxelMap& operator=(VoxelMap&&) = default;
  ~VoxelMap() = default;

  double voxel_size_m() const { return voxel_size_m_; }
  double floor_z_m() const { return floor.level_z_m(); }

  // The voxel; an unknown one when its block does not exist.
  Voxel at(const Eigen::Vector3i& index) const {
    const VoxelBlock* const block = find_block(block_of(index));
    return block == nullptr ? Voxel{}
                            : block->voxels[static_cast<std::size_t>(position_in_block(index))];
  }
  // The same as it lies in memory, without time and ignorance. Good until the map changes.
  const PackedVoxel& packed_at(const Eigen::Vector3i& index) const {
    const VoxelBlock* const block = find_block(block_of(index));
    return block == nullptr
               ? kUnknownVoxel
               : block->voxels.packed(static_cast<std::size_t>(position_in_block(index)));
  }
  // For single voxels; a loop goes through the block.
  void set(const Eigen::Vector3i& index, const Voxel& voxel);

  // The block counts as changed. Ask again before a later change.
  VoxelBlock& find_or_create_block(const Eigen::Vector3i& block_index);
  const VoxelBlock* find_block(const Eigen::Vector3i& block_index) const {
    if (!is_within_reach(block_index)) return nullptr;
    VoxelTile& tile = table_.find(tile_of(block_index));
    if (tile.is_out) bring_back(tile);
    return tile.blocks[position_in_tile(block_index)].get();
  }
  void erase_block(const Eigen::Vector3i& block_index);

  // Tile by tile, in the canonical order of the tiles and of the blocks of each; tiles that are out
  // are read for the visit and not kept.
  using VisitTile =
      std::function<void(const Eigen::Vector3i& tile, std::span<const VoxelBlock* const> blocks)>;
  void for_each_tile(const VisitTile& visit) const;
  template <class Visit>
  void for_each_block(Visit visit) const {
    for_each_tile([&](const Eigen::Vector3i&, std::span<const VoxelBlock* const> blocks) {
      for (const VoxelBlock* const block : blocks) visit(*block);
    });
  }
  // Each tile with a known voxel as a section of map.svx (tile_section.h); tiles that are out come
  // as the store has them.
  void for_each_tile_section(const std::function<void(std::string_view section)>& visit) const;
  // In the canonical order (block_index.h), whatever the order of creation. Reads back all that is
  // out.
  std::vector<const VoxelBlock*> sorted_blocks() const;
  // Those with a voxel in the box, in the canonical order.
  std::vector<const VoxelBlock*> blocks_in(const VoxelBounds& box) const;

  // Change tracking for viewers and planners: blocks created, changed or erased after the stamp was
  // taken, in the canonical order.
  ChangeStamp change_stamp() const { return changes_; }
  std::vector<Eigen::Vector3i> blocks_changed_since(ChangeStamp stamp) const;

  std::size_t block_count() const { return block_count_; }
  KnownCounts known_counts() const;
  std::size_t known_voxel_count() const { return known_counts().voxels; }
  std::optional<VoxelBounds> bounds() const;  // of the known voxels
  std::size_t memory_bytes() const;           // of what is not out

  // From now on tiles may be out. Opens a nameless file in the folder; throws ResourceError.
  void use_store(const std::filesystem::path& folder);
  // Puts tiles out until the map takes at most `bytes`, and a little less so that it need not do so
  // in every frame. Throws ResourceError when a tile cannot be written; it then stays in memory.
  void keep_within(std::size_t bytes);
  std::size_t tiles_out() const { return tiles_out_; }
  // Forgets the tiles that the store cannot give back, so that the rest can be saved; the errors.
  std::vector<std::string> forget_unreadable_tiles();

  // Time stamp of the first frame integrated; last_seen_ms counts from it.
  std::optional<std::int64_t> epoch_ns;
  std::uint32_t frames_integrated = 0;
  // Named blobs that travel with the map in its file.
  std::map<std::string, std::string> attachments;
  FloorSurface floor;

 private:
  static bool is_within_reach(const Eigen::Vector3i& block) {
    constexpr auto kReach = static_cast<unsigned>(kMaxBlockCoordinate);
    const auto is_near = [](int c) { return static_cast<unsigned>(c) + kReach <= 2 * kReach; };
    return is_near(block.x()) && is_near(block.y()) && is_near(block.z());
  }
  VoxelTile& find_or_create_tile(const Eigen::Vector3i& block_index);
  std::vector<VoxelTile*> sorted_tiles() const;
  std::vector<VoxelTile*> tiles_in(const VoxelBounds& box) const;
  TileBlocks read_stored(const VoxelTile& tile) const;
  void bring_back(VoxelTile& tile) const;
  void put_out(VoxelTile& tile);
  void store(VoxelTile& tile);
  void mark_changed(VoxelTile& tile, std::size_t position);
  void measure_later(VoxelTile& tile) const;
  void measure(VoxelTile& tile) const;

  double voxel_size_m_;
  TileTable table_;
  std::vector<std::unique_ptr<VoxelTile>> tiles_;
  std::size_t block_count_ = 0;
  ChangeStamp changes_ = 0;
  std::unique_ptr<TileStore> store_;

  // What only says where things are may change while the map is read.
  mutable std::size_t tiles_out_ = 0;
  mutable std::size_t measured_bytes_ = 0;
  mutable std::vector<VoxelTile*> unmeasured_;
};

}  // namespace stereovox
