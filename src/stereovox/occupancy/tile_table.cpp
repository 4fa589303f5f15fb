#include "stereovox/occupancy/tile_table.h"

#include <utility>

namespace stereovox {

void TileTable::insert(VoxelTile& tile) {
  if (++size_ * kSlotsPerTile > slots_.size()) {
    const auto old = std::exchange(slots_, std::vector<Slot>(2 * slots_.size()));
    for (const Slot& slot : old)
      if (slot.key != kNoKey) slots_[slot_of(slot.key)] = slot;
  }
  const std::uint64_t key = block_key(tile.index);
  slots_[slot_of(key)] = {key, &tile};
}

}  // namespace stereovox
