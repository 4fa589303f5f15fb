// The lattice cut into blocks of 8 x 8 x 8 voxels, and a hash from a block's place to its number.
// Voxel (x, y, z) lies in block (x >> 3, y >> 3, z >> 3), at position x + 8 y + 64 z inside it,
// each taken modulo 8.
#pragma once

#include <Eigen/Core>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <vector>

namespace stereovox {

inline constexpr int kBlockSideLog2 = 3;
inline constexpr int kBlockSide = 1 << kBlockSideLog2;
inline constexpr int kVoxelsPerBlock = kBlockSide * kBlockSide * kBlockSide;
// Block coordinates have 21 bits in the hash's key. At 5 cm this reaches 419 km from the origin.
inline constexpr int kMaxBlockCoordinate = (1 << 20) - 1;

inline Eigen::Vector3i block_of(const Eigen::Vector3i& voxel) {
  return {voxel.x() >> kBlockSideLog2, voxel.y() >> kBlockSideLog2, voxel.z() >> kBlockSideLog2};
}

inline int position_in_block(const Eigen::Vector3i& voxel) {
  constexpr int kInside = kBlockSide - 1;
  return (voxel.x() & kInside) | (voxel.y() & kInside) << kBlockSideLog2 |
         (voxel.z() & kInside) << 2 * kBlockSideLog2;
}

inline Eigen::Vector3i voxel_at(const Eigen::Vector3i& block, int position) {
  constexpr int kInside = kBlockSide - 1;
  return block * kBlockSide + Eigen::Vector3i(position & kInside,
                                              position >> kBlockSideLog2 & kInside,
                                              position >> 2 * kBlockSideLog2);
}

// The canonical order of voxels and of blocks: by x, then y, then z.
struct LatticeOrder {
  bool operator()(const Eigen::Vector3i& a, const Eigen::Vector3i& b) const {
    return std::tuple(a.x(), a.y(), a.z()) < std::tuple(b.x(), b.y(), b.z());
  }
};

// 21 bits for each coordinate.
inline std::uint64_t block_key(const Eigen::Vector3i& block) {
  constexpr int kBits = 21, kOffset = kMaxBlockCoordinate + 1;
  assert(block.cwiseAbs().maxCoeff() <= kMaxBlockCoordinate);
  return static_cast<std::uint64_t>(block.x() + kOffset) << 2 * kBits |
         static_cast<std::uint64_t>(block.y() + kOffset) << kBits |
         static_cast<std::uint64_t>(block.z() + kOffset);
}

// Multiplying by 2^64 / golden ratio spreads neighbouring keys upwards; so that x, the highest part
// of a key, is spread as well, it is first laid over the lower ones.
inline std::size_t hash_of(std::uint64_t key) {
  constexpr std::uint64_t kGolden = 0x9E3779B97F4A7C15ULL;
  return static_cast<std::size_t>(((key ^ key >> 32) * kGolden) >> 32);
}

// Numbers blocks 0, 1, 2, ... in the order in which they are first seen. Open addressing, at most
// half full. Coordinates must lie within +-kMaxBlockCoordinate.
class BlockIndex {
 public:
  static constexpr int kNone = -1;

  int find(const Eigen::Vector3i& block) const {
    return slots_.empty() ? kNone : slots_[slot_of(block_key(block))].number;
  }
  int find_or_insert(const Eigen::Vector3i& block);
  int size() const { return size_; }
  std::size_t memory_bytes() const { return slots_.capacity() * sizeof(Slot); }

 private:
  struct Slot {
    std::uint64_t key = 0;
    int number = kNone;
  };

  std::size_t slot_of(std::uint64_t key) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = hash_of(key) & mask;
    while (slots_[slot].number != kNone && slots_[slot].key != key) slot = (slot + 1) & mask;
    return slot;
  }
  void grow();

  std::vector<Slot> slots_;
  int size_ = 0;
};

}  // namespace stereovox
