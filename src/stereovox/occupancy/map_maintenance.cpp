#include "stereovox/occupancy/map_maintenance.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "stereovox/core/error.h"
#include "stereovox/core/grid_geometry.h"
#include "stereovox/core/timestamp.h"
#include "stereovox/occupancy/voxel_update.h"

namespace stereovox {
namespace {

// The places of blocks, which may then be changed one by one.
std::vector<Eigen::Vector3i> all_blocks(const VoxelMap& map) {
  std::vector<Eigen::Vector3i> places;
  map.for_each_block([&](const VoxelBlock& block) { places.push_back(block.index); });
  return places;
}

// Gives each known voxel of a block to `change`(voxel index, voxel), which says whether it keeps
// it. A block without changes stays unmarked, one that knows nothing any more goes.
template <class Change>
void change_block(const Eigen::Vector3i& place, VoxelMap& map, Change change) {
  const VoxelBlock* const block = map.find_block(place);
  if (block == nullptr) return;
  BlockVoxels voxels = block->voxels;
  bool has_changed = false;
  for_each_in(block->voxels.known(), [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    const Voxel before = voxels[at];
    Voxel voxel = before;
    if (!change(voxel_at(place, i), voxel)) voxel = Voxel{};
    if (voxel == before) return;
    voxels.set(at, voxel);
    has_changed = true;
  });
  if (!has_changed) return;
  if (voxels.known_count() == 0)
    map.erase_block(place);
  else
    map.find_or_create_block(place).voxels = std::move(voxels);
}

Voxel joined(const Voxel& a, const Voxel& b) {
  if (!is_known(a)) return b;
  const double weight_a = a.observations, weight_b = b.observations;
  const auto mean = [&](double x, double y) {
    return (weight_a * x + weight_b * y) / (weight_a + weight_b);
  };
  const int count = a.observations + b.observations;
  return {
      .state = static_cast<float>(mean(static_cast<double>(a.state), static_cast<double>(b.state))),
      .last_seen_ms = std::max(a.last_seen_ms, b.last_seen_ms),
      .observations = static_cast<std::uint16_t>(
          std::min<int>(count, std::numeric_limits<std::uint16_t>::max())),
      .ignorance = static_cast<std::uint16_t>(std::lround(mean(a.ignorance, b.ignorance)))};
}

// A time of one map on the clock of another whose epoch is `shift_ms` earlier.
std::uint32_t shifted(std::uint32_t time_ms, std::int64_t shift_ms) {
  constexpr std::int64_t kLatest = std::numeric_limits<std::uint32_t>::max();
  return static_cast<std::uint32_t>(std::clamp<std::int64_t>(time_ms + shift_ms, 0, kLatest));
}

std::int64_t shift_between(const VoxelMap& other, const VoxelMap& map) {
  constexpr std::int64_t kNsPerMs = 1'000'000;
  return other.epoch_ns && map.epoch_ns ? (*other.epoch_ns - *map.epoch_ns) / kNsPerMs : 0;
}

// Throws Error when a voxel of `other` would come to lie where the lattice has no blocks.
void check_reach(const VoxelMap& other, const SE3& T_map_other) {
  const std::optional<VoxelBounds> bounds = other.bounds();
  if (!bounds) return;
  const double size_m = other.voxel_size_m();
  const double limit_m = size_m * kBlockSide * kMaxBlockCoordinate;
  for (const int x : {bounds->min.x(), bounds->max.x()})
    for (const int y : {bounds->min.y(), bounds->max.y()})
      for (const int z : {bounds->min.z(), bounds->max.z()}) {
        const Eigen::Vector3d p = T_map_other * voxel_center_of(size_m, {x, y, z});
        if (!(p.cwiseAbs().maxCoeff() < limit_m))
          throw Error(
              fmt::format("a voxel moved to ({:g}, {:g}, {:g}) m is beyond the map's limit of "
                          "{:.0f} m from the origin",
                          p.x(), p.y(), p.z(), limit_m));
      }
}

// The most occupied state, and of count, time and ignorance those of the voxel that was seen most.
Voxel coarse(const Voxel& a, const Voxel& b) {
  if (!is_known(a)) return b;
  Voxel most = b.observations > a.observations ? b : a;
  most.state = std::max(a.state, b.state);
  most.last_seen_ms = std::max(a.last_seen_ms, b.last_seen_ms);
  return most;
}

}  // namespace

void clear_box(const VoxelBounds& box, VoxelMap& map) {
  std::vector<Eigen::Vector3i> places;
  for (const VoxelBlock* const block : map.blocks_in(box)) places.push_back(block->index);
  for (const Eigen::Vector3i& place : places)
    change_block(place, map,
                 [&](const Eigen::Vector3i& voxel, Voxel&) { return !box.contains(voxel); });
}

void crop(const VoxelBounds& box, VoxelMap& map) {
  for (const Eigen::Vector3i& place : all_blocks(map))
    change_block(place, map,
                 [&](const Eigen::Vector3i& voxel, Voxel&) { return box.contains(voxel); });
}

void merge(const VoxelMap& other, const SE3& T_map_other, VoxelMap& map) {
  if (other.voxel_size_m() != map.voxel_size_m())
    throw Error(fmt::format("maps with voxels of {} m and of {} m cannot be merged",
                            map.voxel_size_m(), other.voxel_size_m()));
  check_reach(other, T_map_other);
  if (!map.epoch_ns) map.epoch_ns = other.epoch_ns;
  const std::int64_t shift_ms = shift_between(other, map);
  other.for_each_block([&](const VoxelBlock& block) {
    for_each_in(block.voxels.known(), [&](int i) {
      Voxel voxel = block.voxels[static_cast<std::size_t>(i)];
      voxel.last_seen_ms = shifted(voxel.last_seen_ms, shift_ms);
      const Eigen::Vector3d center =
          T_map_other * voxel_center_of(map.voxel_size_m(), voxel_at(block.index, i));
      const Eigen::Vector3i place = voxel_index_of(map.voxel_size_m(), center);
      map.set(place, joined(map.at(place), voxel));
    });
  });
  map.floor.merge(other.floor, T_map_other);
  map.frames_integrated += other.frames_integrated;
}

VoxelMap downsampled(const VoxelMap& map, int factor) {
  if (factor < 2 || !std::has_single_bit(static_cast<unsigned>(factor)))
    throw std::logic_error("downsampled: the factor is not 2, 4, 8, ...");
  const int shift = std::countr_zero(static_cast<unsigned>(factor));
  VoxelMap out(map.voxel_size_m() * factor, map.floor_z_m());
  out.epoch_ns = map.epoch_ns;
  out.frames_integrated = map.frames_integrated;
  out.floor = map.floor;
  map.for_each_block([&](const VoxelBlock& block) {
    for_each_in(block.voxels.known(), [&](int i) {
      const Eigen::Vector3i voxel = voxel_at(block.index, i);
      const Eigen::Vector3i place(voxel.x() >> shift, voxel.y() >> shift, voxel.z() >> shift);
      out.set(place, coarse(out.at(place), block.voxels[static_cast<std::size_t>(i)]));
    });
  });
  return out;
}

void decay(const DecayParams& params, std::uint32_t now_ms, VoxelMap& map) {
  constexpr double kUndecided = 0.5;
  for (const Eigen::Vector3i& place : all_blocks(map))
    change_block(place, map, [&](const Eigen::Vector3i&, Voxel& voxel) {
      const double faded = std::exp(-age_s(voxel.last_seen_ms, now_ms) / params.time_constant_s);
      const double distance = (static_cast<double>(voxel.state) - kUndecided) * faded;
      if (faded < 1.0) voxel.state = static_cast<float>(kUndecided + distance);
      return std::abs(distance) >= params.forget_below;
    });
}

}  // namespace stereovox
