// 8 x 8 x 8 voxels in 8 bytes each: a voxel keeps its state, its count and the number of its time
// in a list that the block's voxels share, because few frames see a block for the last time.
// Ignorance takes memory only in blocks that have it. Nothing is rounded.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <iterator>
#include <limits>
#include <memory>
#include <vector>

#include "stereovox/occupancy/block_index.h"
#include "stereovox/occupancy/voxel.h"
#include "stereovox/occupancy/voxel_mask.h"

namespace stereovox {

// A voxel as it lies in memory.
struct PackedVoxel {
  float state = 0.0F;
  std::uint16_t observations = 0;
  std::uint16_t time = 0;  // number of its time in the block
};
static_assert(sizeof(PackedVoxel) == 8);
inline constexpr PackedVoxel kUnknownVoxel{};

// Values of the voxels of one layer z of a block, at x + 8 y.
template <class Value>
using PerVoxelOfLayer = std::array<Value, kBlockSide * kBlockSide>;

class BlockVoxels {
 public:
  BlockVoxels() = default;
  BlockVoxels(const BlockVoxels& other) { *this = other; }
  BlockVoxels& operator=(const BlockVoxels& other);
  BlockVoxels(BlockVoxels&&) = default;
  BlockVoxels& operator=(BlockVoxels&&) = default;
  ~BlockVoxels() = default;

  Voxel operator[](std::size_t position) const {
    const PackedVoxel& packed = packed_[position];
    return {packed.state, times_ms_[packed.time], packed.observations,
            ignorance_ == nullptr ? std::uint16_t{0} : (*ignorance_)[position]};
  }
  void set(std::size_t position, const Voxel& voxel);
  // The same when the number of the voxel's time is known.
  void set(std::size_t position, const Voxel& voxel, std::uint16_t time) {
    packed_[position] = {voxel.state, voxel.observations, time};
    if (voxel.ignorance > 0 && ignorance_ == nullptr) ignorance_ = std::make_unique<Ignorance>();
    if (ignorance_ != nullptr) (*ignorance_)[position] = voxel.ignorance;
  }

  // One more observation, without ignorance, at this time, which has this number.
  void observe(std::size_t position, float state, std::uint32_t time_ms, std::uint16_t time) {
    PackedVoxel& voxel = packed_[position];
    if (voxel.observations == 0 || time_ms > times_ms_[voxel.time]) voxel.time = time;
    if (voxel.observations < std::numeric_limits<std::uint16_t>::max()) ++voxel.observations;
    voxel.state = state;
    if (ignorance_ != nullptr) (*ignorance_)[position] = 0;
  }

  // The same for each voxel of layer z that has a bit in `observed`.
  void observe_layer(int z, std::uint64_t observed, const PerVoxelOfLayer<float>& states,
                     std::uint32_t time_ms, std::uint16_t time);

  // States and counts of the voxels of layer z; a state means nothing where the count is 0.
  void load_layer(int z, PerVoxelOfLayer<float>& states,
                  PerVoxelOfLayer<std::int32_t>& observations) const;

  // For loops over a block: the voxel without its ignorance, and the number of a time, which stays
  // good until the next one is asked for.
  PackedVoxel& packed(std::size_t position) { return packed_[position]; }
  const PackedVoxel& packed(std::size_t position) const { return packed_[position]; }
  std::uint32_t time_ms(const PackedVoxel& voxel) const { return times_ms_[voxel.time]; }
  std::uint16_t number_of_time(std::uint32_t time_ms);

  VoxelMask known() const;
  std::size_t known_count() const;
  bool has_ignorance() const;
  std::size_t size() const { return packed_.size(); }
  // Beside the object itself.
  std::size_t extra_bytes() const;

  // Voxels in the order of their positions, by value.
  class Iterator {
   public:
    using value_type = Voxel;
    using difference_type = std::ptrdiff_t;

    Iterator() = default;
    Iterator(const BlockVoxels& voxels, std::size_t position)
        : voxels_(&voxels), position_(position) {}
    Voxel operator*() const { return (*voxels_)[position_]; }
    Iterator& operator++() { return ++position_, *this; }
    Iterator operator++(int) { return {*voxels_, position_++}; }
    bool operator==(const Iterator&) const = default;

   private:
    const BlockVoxels* voxels_ = nullptr;
    std::size_t position_ = 0;
  };
  Iterator begin() const { return {*this, 0}; }
  Iterator end() const { return {*this, size()}; }

 private:
  using Ignorance = std::array<std::uint16_t, kVoxelsPerBlock>;

  void forget_unused_times();

  std::array<PackedVoxel, kVoxelsPerBlock> packed_{};
  std::vector<std::uint32_t> times_ms_ = {0};  // distinct; the first one serves unknown voxels
  std::unique_ptr<Ignorance> ignorance_;       // nullptr: all 0
};

struct VoxelBlock {
  Eigen::Vector3i index;  // of the block
  BlockVoxels voxels;
};

}  // namespace stereovox
