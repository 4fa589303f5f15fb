#include "stereovox/occupancy/block_index.h"

#include <cassert>
#include <utility>

namespace stereovox {
namespace {

constexpr std::size_t kFirstCapacity = 64;  // a power of two

std::uint64_t key_of(const Eigen::Vector3i& block) {
  assert(block.cwiseAbs().maxCoeff() <= kMaxBlockCoordinate);
  constexpr int kBits = 21;
  const auto part = [&](int axis) {
    return static_cast<std::uint64_t>(block[axis] + kMaxBlockCoordinate + 1);
  };
  return part(0) << 2 * kBits | part(1) << kBits | part(2);
}

// Multiplying by 2^64 / golden ratio spreads neighbouring keys; the high bits are the mixed ones.
std::size_t hash_of(std::uint64_t key) {
  constexpr std::uint64_t kGolden = 0x9E3779B97F4A7C15ULL;
  return static_cast<std::size_t>((key * kGolden) >> 32);
}

}  // namespace

std::size_t BlockIndex::slot_of(std::uint64_t key) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = hash_of(key) & mask;
  while (slots_[slot].number != kNone && slots_[slot].key != key) slot = (slot + 1) & mask;
  return slot;
}

int BlockIndex::find(const Eigen::Vector3i& block) const {
  return slots_.empty() ? kNone : slots_[slot_of(key_of(block))].number;
}

int BlockIndex::find_or_insert(const Eigen::Vector3i& block) {
  if (2 * (static_cast<std::size_t>(size_) + 1) > slots_.size()) grow();
  const std::uint64_t key = key_of(block);
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
