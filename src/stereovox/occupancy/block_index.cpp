#include "stereovox/occupancy/block_index.h"

#include <utility>

namespace stereovox {
namespace {

constexpr std::size_t kFirstCapacity = 64;  // a power of two

}  // namespace

int BlockIndex::find_or_insert(const Eigen::Vector3i& block) {
  if (2 * (static_cast<std::size_t>(size_) + 1) > slots_.size()) grow();
  const std::uint64_t key = block_key(block);
  Slot& slot = slots_[slot_of(key)];
  if (slot.number == kNone) slot = {key, size_++};
  return slot.number;
}

void BlockIndex::grow() {
  const std::vector<Slot> old =
      std::exchange(slots_, std::vector<Slot>(slots_.empty() ? kFirstCapacity : 2 * slots_.size()));
  for (const Slot& slot : old)
    if (slot.number != kNone) slots_[slot_of(slot.key)] = slot;
}

}  // namespace stereovox
