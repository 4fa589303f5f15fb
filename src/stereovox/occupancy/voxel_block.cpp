#include "stereovox/occupancy/voxel_block.h"

#include <algorithm>
#include <bit>

namespace stereovox {
namespace {

// At least one time of that many is unused when each voxel has one of its own.
constexpr std::size_t kMaxTimes = 2 * kVoxelsPerBlock;

}  // namespace

BlockVoxels& BlockVoxels::operator=(const BlockVoxels& other) {
  packed_ = other.packed_;
  times_ms_ = other.times_ms_;
  ignorance_ =
      other.ignorance_ == nullptr ? nullptr : std::make_unique<Ignorance>(*other.ignorance_);
  return *this;
}

void BlockVoxels::set(std::size_t position, const Voxel& voxel) {
  set(position, voxel, number_of_time(voxel.last_seen_ms));
}

std::uint16_t BlockVoxels::number_of_time(std::uint32_t time_ms) {
  const auto number_after = [&](auto found) {
    return static_cast<std::uint16_t>(times_ms_.rend() - found - 1);
  };
  // The time asked for is mostly the latest.
  if (const auto found = std::find(times_ms_.rbegin(), times_ms_.rend(), time_ms);
      found != times_ms_.rend())
    return number_after(found);
  if (times_ms_.size() == kMaxTimes) forget_unused_times();
  times_ms_.push_back(time_ms);
  return static_cast<std::uint16_t>(times_ms_.size() - 1);
}

void BlockVoxels::forget_unused_times() {
  std::array<std::uint16_t, kMaxTimes> new_number{};
  std::vector<std::uint32_t> used = {times_ms_.front()};
  for (PackedVoxel& voxel : packed_) {
    if (voxel.time == 0) continue;
    std::uint16_t& number = new_number[voxel.time];
    if (number == 0) {
      number = static_cast<std::uint16_t>(used.size());
      used.push_back(times_ms_[voxel.time]);
    }
    voxel.time = number;
  }
  times_ms_ = std::move(used);
}

VoxelMask BlockVoxels::known() const {
  VoxelMask known;
  for (std::size_t i = 0; i < packed_.size(); ++i)
    if (packed_[i].observations > 0) known.set(static_cast<int>(i));
  return known;
}

std::size_t BlockVoxels::known_count() const {
  return static_cast<std::size_t>(std::ranges::count_if(
      packed_, [](const PackedVoxel& voxel) { return voxel.observations > 0; }));
}

bool BlockVoxels::has_ignorance() const {
  if (ignorance_ == nullptr) return false;
  for (std::size_t i = 0; i < packed_.size(); ++i)
    if (packed_[i].observations > 0 && (*ignorance_)[i] > 0) return true;
  return false;
}

std::size_t BlockVoxels::extra_bytes() const {
  return times_ms_.capacity() * sizeof(times_ms_.front()) +
         (ignorance_ == nullptr ? 0 : sizeof(Ignorance));
}

}  // namespace stereovox
