#include "stereovox/occupancy/integrate.h"

#include <algorithm>
#include <array>

#include "stereovox/core/parallel.h"
#include "stereovox/occupancy/frame_observation.h"
#include "stereovox/occupancy/frame_visibility.h"
#include "stereovox/occupancy/voxel_update.h"

namespace stereovox {
namespace {

// A block's observations with a border of one voxel on every side.
constexpr int kPaddedSide = kBlockSide + 2;

constexpr int padded_position(int x, int y, int z) {
  return (x + 1) + kPaddedSide * ((y + 1) + kPaddedSide * (z + 1));
}

int padded_position_of(int position) {
  const Eigen::Vector3i local = voxel_at(Eigen::Vector3i::Zero(), position);
  return padded_position(local.x(), local.y(), local.z());
}

class PaddedObservations {
 public:
  PaddedObservations(const FrameObservation& frame, const BlockObservation& center) {
    std::array<const BlockObservation*, kCube> blocks{};
    for (int i = 0; i < kCube; ++i) {
      const int number = frame.index.find(center.index + step_to(i));
      if (number == BlockIndex::kNone) continue;
      blocks[static_cast<std::size_t>(i)] = &frame.blocks[static_cast<std::size_t>(number)];
      has_hits_ = has_hits_ || !frame.blocks[static_cast<std::size_t>(number)].values.empty();
    }
    if (!has_hits_) return;
    values_.fill(kUnobserved);
    for (int i = 0; i < kCube; ++i)
      if (blocks[static_cast<std::size_t>(i)] != nullptr)
        copy_overlap(*blocks[static_cast<std::size_t>(i)], step_to(i));
  }

  // When nothing near is hit, every observation near is 0 and so is H.
  bool is_uniform() const { return !has_hits_; }

  double heterogeneity_at(int position, const HomogeneityParams& params,
                          std::span<const int> neighbours) const {
    const int center = padded_position_of(position);
    std::array<float, 26> values{};
    for (std::size_t i = 0; i < neighbours.size(); ++i)
      values[i] = values_[static_cast<std::size_t>(center + neighbours[i])];
    return heterogeneity(params, values_[static_cast<std::size_t>(center)],
                         std::span(values).first(neighbours.size()));
  }

 private:
  static constexpr int kCube = 27;  // the block and those around it

  static Eigen::Vector3i step_to(int i) { return {i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1}; }

  void copy_overlap(const BlockObservation& block, const Eigen::Vector3i& step) {
    const auto low = [](int s) { return s < 0 ? kBlockSide - 1 : 0; };
    const auto high = [](int s) { return s > 0 ? 0 : kBlockSide - 1; };
    for (int z = low(step.z()); z <= high(step.z()); ++z)
      for (int y = low(step.y()); y <= high(step.y()); ++y)
        for (int x = low(step.x()); x <= high(step.x()); ++x)
          values_[static_cast<std::size_t>(padded_position(
              x + kBlockSide * step.x(), y + kBlockSide * step.y(), z + kBlockSide * step.z()))] =
              block.value_at(position_in_block({x, y, z}));
  }

  std::array<float, kPaddedSide * kPaddedSide * kPaddedSide> values_;  // not while uniform
  bool has_hits_ = false;
};

std::vector<int> padded_steps(Neighbourhood neighbourhood) {
  std::vector<int> steps;
  for (const Eigen::Vector3i& step : neighbour_steps(neighbourhood))
    steps.push_back(step.x() + kPaddedSide * (step.y() + kPaddedSide * step.z()));
  return steps;
}

// A rule's age factor, which most voxels of a block share.
template <class Rule>
class AgeFactor {
 public:
  explicit AgeFactor(const Rule& rule) : rule_(rule), factor_(rule.age_factor(0.0)) {}

  double of(const Voxel& voxel, std::uint32_t stamp_ms) {
    if (!is_known(voxel)) return 1.0;
    const double age = age_s(voxel, stamp_ms);
    if (age != age_s_) factor_ = rule_.age_factor(age);
    age_s_ = age;
    return factor_;
  }

 private:
  const Rule& rule_;
  double age_s_ = 0.0;
  double factor_;
};

// A frame and the blocks that it changes.
struct FrameChange {
  const FrameView& frame;
  const FrameObservation& observation;
  // By number in the observation; nullptr when nothing is observed.
  std::vector<VoxelBlock*> blocks;
  int threads = 1;
};

std::vector<VoxelBlock*> blocks_of(const FrameObservation& observation, VoxelMap& map) {
  std::vector<VoxelBlock*> blocks;
  for (const BlockObservation& seen : observation.blocks)
    blocks.push_back(seen.observed.is_empty() ? nullptr : &map.find_or_create_block(seen.index));
  return blocks;
}

// Calls update(number, seen, block) for each block, on threads.
template <class Update>
void for_each_block(const FrameChange& change, Update update) {
  parallel_for(0, static_cast<int>(change.blocks.size()), change.threads, [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    if (change.blocks[at] != nullptr) update(at, change.observation.blocks[at], *change.blocks[at]);
  });
}

// Changes voxels of one block by one frame. A voxel's time becomes the frame's or stays.
class BlockChange {
 public:
  BlockChange(VoxelBlock& block, std::uint32_t stamp_ms)
      : voxels_(block.voxels), stamp_ms_(stamp_ms), time_(voxels_.number_of_time(stamp_ms)) {}

  template <class Change>
  void apply(int position, Change change) {
    const auto at = static_cast<std::size_t>(position);
    Voxel voxel = voxels_[at];
    change(voxel);
    voxels_.set(at, voxel, voxel.last_seen_ms == stamp_ms_ ? time_ : voxels_.packed(at).time);
  }

 private:
  BlockVoxels& voxels_;
  std::uint32_t stamp_ms_;
  std::uint16_t time_;
};

// Step 5 for one block, in two passes over the frame: all O_t were there before any H is asked for.
template <WeighingRule Rule>
void update_block(const Rule& rule, const FrameChange& change, std::span<const int> neighbours,
                  std::uint32_t frames_before, const BlockObservation& seen, VoxelBlock& block) {
  const OccupancyParams& params = change.frame.params;
  const std::uint32_t stamp_ms = change.frame.stamp_ms;
  const PaddedObservations padded(change.observation, seen);
  AgeFactor<Rule> age_factor(rule);
  BlockChange block_change(block, stamp_ms);
  for_each_in(seen.observed, [&](int i) {
    const double H =
        padded.is_uniform() ? 0.0 : padded.heterogeneity_at(i, params.homogeneity, neighbours);
    block_change.apply(i, [&](Voxel& voxel) {
      const double k = rule.credibility({.prior_observations = voxel.observations,
                                         .homogeneity = homogeneity(params.homogeneity, H),
                                         .age_factor = age_factor.of(voxel, stamp_ms),
                                         .frames_before = frames_before});
      update_voxel(seen.value_at(i), k, params.initial_state, stamp_ms, voxel);
    });
  });
}

template <WeighingRule Rule>
void update_map(const Rule& rule, const FrameChange& change, const VoxelMap& map) {
  const std::vector<int> neighbours = padded_steps(change.frame.params.homogeneity.neighbours);
  for_each_block(change, [&](std::size_t, const BlockObservation& seen, VoxelBlock& block) {
    update_block(rule, change, neighbours, map.frames_integrated, seen, block);
  });
}

template <AddingRule Rule>
void update_map(const Rule& rule, const FrameChange& change, const VoxelMap&) {
  const std::uint32_t stamp_ms = change.frame.stamp_ms;
  for_each_block(change, [&](std::size_t, const BlockObservation& seen, VoxelBlock& block) {
    BlockChange block_change(block, stamp_ms);
    for_each_in(seen.observed, [&](int i) {
      block_change.apply(i, [&](Voxel& voxel) {
        store(rule.after(belief_of(voxel), seen.value_at(i)), stamp_ms, voxel);
      });
    });
  });
}

void update_map(const VisibilityRule& rule, const FrameChange& change, const VoxelMap& map) {
  const auto visibility =
      frame_visibility(rule, change.frame, change.observation, map, change.threads);
  const std::uint32_t stamp_ms = change.frame.stamp_ms;
  for_each_block(change, [&](std::size_t number, const BlockObservation& seen, VoxelBlock& block) {
    BlockChange block_change(block, stamp_ms);
    for_each_in(seen.observed, [&](int i) {
      const auto visible = static_cast<double>(visibility[number][static_cast<std::size_t>(i)]);
      block_change.apply(
          i, [&](Voxel& voxel) { update_voxel(rule, seen.value_at(i), visible, stamp_ms, voxel); });
    });
  });
}

// Sorts numbers in place of voxels, which is several times faster. A frame is less than 2^21 voxels
// wide.
void sort_canonically(std::vector<Eigen::Vector3i>& voxels) {
  if (voxels.empty()) return;
  constexpr int kBits = 21, kMask = (1 << kBits) - 1;
  Eigen::Vector3i low = voxels.front();
  for (const Eigen::Vector3i& voxel : voxels) low = low.cwiseMin(voxel);
  std::vector<std::uint64_t> keys;
  keys.reserve(voxels.size());
  for (const Eigen::Vector3i& voxel : voxels) {
    const Eigen::Matrix<std::uint64_t, 3, 1> place = (voxel - low).cast<std::uint64_t>();
    keys.push_back(place.x() << 2 * kBits | place.y() << kBits | place.z());
  }
  std::ranges::sort(keys);
  for (std::size_t i = 0; i < keys.size(); ++i)
    voxels[i] = low + Eigen::Vector3i(static_cast<int>(keys[i] >> 2 * kBits),
                                      static_cast<int>(keys[i] >> kBits & kMask),
                                      static_cast<int>(keys[i] & kMask));
}

FrameUpdate summary_of(const FrameObservation& observation) {
  FrameUpdate update;
  update.points_used = observation.points_used;
  int observed = 0;
  for (const BlockObservation& block : observation.blocks) {
    for (const std::uint64_t word : block.observed.words) observed += std::popcount(word);
    for_each_in(block.hit, [&](int i) { update.hits.push_back(voxel_at(block.index, i)); });
  }
  sort_canonically(update.hits);
  update.hit_voxels = static_cast<int>(update.hits.size());
  update.free_voxels = observed - update.hit_voxels;
  return update;
}

}  // namespace

FrameUpdate integrate(const DisparityImage& disparity, const RectifiedCamera& camera,
                      const SE3& T_world_camera, std::int64_t stamp_ns,
                      const OccupancyParams& params, int threads, VoxelMap& map) {
  const FrameView frame = view_frame(disparity, camera, T_world_camera, stamp_ns, params, map);
  const FrameObservation observation = observe_frame(frame, map, threads);
  const FrameChange change{.frame = frame,
                           .observation = observation,
                           .blocks = blocks_of(observation, map),
                           .threads = threads};
  std::visit([&](const auto& rule) { update_map(rule, change, map); }, params.update);
  ++map.frames_integrated;
  return summary_of(observation);
}

}  // namespace stereovox
