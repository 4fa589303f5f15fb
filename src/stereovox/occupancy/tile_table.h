// A hash from a tile's place to the tile.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "stereovox/occupancy/voxel_tile.h"

namespace stereovox {

// Open addressing, at most an eighth full, so that a search nearly always ends where it begins. One
// in vain ends at a tile without blocks: no processor can foresee which look-ups of a planner leave
// the map, and a wrong guess costs more than the look-up.
class TileTable {
 public:
  // `tile` must lie within the reach of block_key.
  VoxelTile& find(const Eigen::Vector3i& tile) const {
    return *slots_[slot_of(block_key(tile))].tile;
  }
  static bool is_there(const VoxelTile& tile) { return &tile != &no_tile(); }
  // Under tile.index, where none may be yet. Refers to the tile.
  void insert(VoxelTile& tile);
  std::size_t memory_bytes() const { return slots_.capacity() * sizeof(Slot); }

 private:
  static constexpr std::uint64_t kNoKey = std::numeric_limits<std::uint64_t>::max();
  static constexpr std::size_t kSlotsPerTile = 8, kFirstCapacity = 64;  // powers of two

  struct Slot {
    std::uint64_t key = kNoKey;
    VoxelTile* tile = &no_tile();
  };

  static VoxelTile& no_tile() {
    static VoxelTile nothing;
    return nothing;
  }
  std::size_t slot_of(std::uint64_t key) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = hash_of(key) & mask;
    while (is_taken_by_other(slots_[slot].key, key)) slot = (slot + 1) & mask;
    return slot;
  }
  // One comparison, which nearly always says no, not one that depends on whether the tile is there.
  static bool is_taken_by_other(std::uint64_t taken, std::uint64_t key) {
    return std::min(taken ^ key, taken ^ kNoKey) != 0;
  }

  std::vector<Slot> slots_ = std::vector<Slot>(kFirstCapacity);
  std::size_t size_ = 0;
};

}  // namespace stereovox
