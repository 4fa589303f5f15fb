#include "stereovox/occupancy/voxel_block.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "stereovox/occupancy/vector_target.h"

namespace stereovox {
namespace {

// At least one time of that many is unused when each voxel has one of its own.
constexpr std::size_t kMaxTimes = 2 * kVoxelsPerBlock;

// A voxel as one number, so that many change at once.
using VoxelBits = std::uint64_t;
static_assert(std::endian::native == std::endian::little);
constexpr int kObservationsAt = 32, kTimeAt = 48;
constexpr VoxelBits kMaxObservations = std::numeric_limits<std::uint16_t>::max();

struct LoadLayer {
  [[gnu::always_inline]] void operator()(const PackedVoxel* const& layer,
                                         PerVoxelOfLayer<float>& states,
                                         PerVoxelOfLayer<std::int32_t>& observations) const {
    PerVoxelOfLayer<VoxelBits> voxels;
    std::memcpy(voxels.data(), layer, sizeof voxels);
    for (std::size_t i = 0; i < voxels.size(); ++i) {
      states[i] = std::bit_cast<float>(static_cast<std::uint32_t>(voxels[i]));
      observations[i] = static_cast<std::int32_t>(voxels[i] >> kObservationsAt & kMaxObservations);
    }
  }
};

struct ObserveLayer {
  [[gnu::always_inline]] void operator()(const std::uint64_t& observed,
                                         const PerVoxelOfLayer<float>& states,
                                         const std::uint16_t& time,
                                         PackedVoxel* const& layer) const {
    const VoxelBits which = observed, time_bits = VoxelBits{time} << kTimeAt;
    PerVoxelOfLayer<VoxelBits> voxels;
    std::memcpy(voxels.data(), layer, sizeof voxels);
    for (std::size_t i = 0; i < voxels.size(); ++i) {
      const VoxelBits before = voxels[i];
      const VoxelBits seen = before >> kObservationsAt & kMaxObservations;
      const VoxelBits count = seen < kMaxObservations ? seen + 1 : seen;
      const VoxelBits now =
          time_bits | count << kObservationsAt | std::bit_cast<std::uint32_t>(states[i]);
      voxels[i] = (which >> i & 1) != 0 ? now : before;
    }
    std::memcpy(static_cast<void*>(layer), voxels.data(), sizeof voxels);
  }
};

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

void BlockVoxels::load_layer(int z, PerVoxelOfLayer<float>& states,
                             PerVoxelOfLayer<std::int32_t>& observations) const {
  const PackedVoxel* const layer = &packed_[static_cast<std::size_t>(z) * states.size()];
  on_best_target(LoadLayer{}, layer, states, observations);
}

void BlockVoxels::observe_layer(int z, std::uint64_t observed, const PerVoxelOfLayer<float>& states,
                                std::uint32_t time_ms, std::uint16_t time) {
  const std::size_t first = static_cast<std::size_t>(z) * states.size();
  const bool is_latest = time_ms >= *std::ranges::max_element(times_ms_);
  if (is_latest && ignorance_ == nullptr) {
    PackedVoxel* const layer = &packed_[first];
    return on_best_target(ObserveLayer{}, observed, states, time, layer);
  }
  for (std::uint64_t rest = observed; rest != 0; rest &= rest - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(rest));
    observe(first + i, states[i], time_ms, time);
  }
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
