#include "stereovox/occupancy/integrate.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <utility>

#include "stereovox/core/parallel.h"
#include "stereovox/occupancy/frame_observation.h"
#include "stereovox/occupancy/frame_visibility.h"
#include "stereovox/occupancy/padded_observations.h"
#include "stereovox/occupancy/voxel_update.h"

namespace stereovox {
namespace {

// A rule's age factor, which most voxels of a block share.
template <class Rule>
class AgeFactor {
 public:
  AgeFactor(const Rule& rule, const BlockVoxels& voxels, std::uint32_t stamp_ms)
      : rule_(rule), voxels_(voxels), stamp_ms_(stamp_ms) {}

  double of(const PackedVoxel& voxel) {
    if (voxel.observations == 0) return 1.0;
    if (voxel.time != time_) factor_ = rule_.age_factor(age_s(voxels_.time_ms(voxel), stamp_ms_));
    time_ = voxel.time;
    return factor_;
  }

 private:
  const Rule& rule_;
  const BlockVoxels& voxels_;
  std::uint32_t stamp_ms_;
  int time_ = -1;  // none
  double factor_ = 1.0;
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

// The voxels of one layer of a block before an observation, and what they become by it.
struct LayerChange {
  PerVoxelOfLayer<float> observation, state;
  PerVoxelOfLayer<std::int32_t> observations;
  PerVoxelOfLayer<double> heterogeneity, age_factor;  // for rules that weigh
};

// Calls change(z, layer) for each layer of the block that is observed, and stores what it becomes.
template <class Change>
void change_layers(const BlockObservation& seen, std::uint32_t stamp_ms, BlockVoxels& voxels,
                   Change change) {
  const std::uint16_t time = voxels.number_of_time(stamp_ms);
  LayerChange layer;
  layer.observation.fill(0.0F);
  for (int z = 0; z < kBlockSide; ++z) {
    const std::uint64_t observed = seen.observed.words[static_cast<std::size_t>(z)];
    if (observed == 0) continue;
    if (!seen.values.empty())
      std::copy_n(seen.values.begin() + z * std::ssize(layer.observation), layer.observation.size(),
                  layer.observation.begin());
    voxels.load_layer(z, layer.state, layer.observations);
    change(z, layer);
    voxels.observe_layer(z, observed, layer.state, stamp_ms, time);
  }
}

// Eqs. (16) and (14).
struct WeighLayer {
  template <WeighingRule Rule>
  [[gnu::always_inline]] void operator()(const Rule& rule, const OccupancyParams& params,
                                         std::uint32_t frames_before, LayerChange& layer) const {
    const HomogeneityParams homogeneity_params = params.homogeneity;
    const double initial_state = params.initial_state;
    const Rule weighing = rule;
    for (std::size_t i = 0; i < layer.state.size(); ++i) {
      const double k = weighing.credibility(
          {.prior_observations = layer.observations[i],
           .homogeneity = homogeneity(homogeneity_params, layer.heterogeneity[i]),
           .age_factor = layer.age_factor[i],
           .frames_before = frames_before});
      const double state = layer.observations[i] > 0 ? layer.state[i] : initial_state;
      layer.state[i] = static_cast<float>((1.0 - k) * state + k * layer.observation[i]);
    }
  }
};

// Step 5 for one block, in two passes over the frame: all O_t were there before any H is asked for.
template <WeighingRule Rule>
void update_block(const Rule& rule, const FrameChange& change, std::uint32_t frames_before,
                  const BlockObservation& seen, VoxelBlock& block) {
  const OccupancyParams& params = change.frame.params;
  const std::uint32_t stamp_ms = change.frame.stamp_ms;
  const PaddedObservations padded(change.observation, seen);
  AgeFactor<Rule> age_factor(rule, block.voxels, stamp_ms);
  change_layers(seen, stamp_ms, block.voxels, [&](int z, LayerChange& layer) {
    const std::size_t first = static_cast<std::size_t>(z) * layer.state.size();
    for (std::size_t i = 0; i < layer.state.size(); ++i)
      layer.age_factor[i] = age_factor.of(block.voxels.packed(first + i));
    if (padded.is_uniform())
      layer.heterogeneity.fill(0.0);
    else
      padded.heterogeneities(z, params.homogeneity, layer.heterogeneity);
    on_best_target(WeighLayer{}, rule, params, frames_before, layer);
  });
}

template <WeighingRule Rule>
void update_map(const Rule& rule, const FrameChange& change, const VoxelMap& map) {
  for_each_block(change, [&](std::size_t, const BlockObservation& seen, VoxelBlock& block) {
    update_block(rule, change, map.frames_integrated, seen, block);
  });
}

struct AddLayer {
  template <AddingRule Rule>
  [[gnu::always_inline]] void operator()(const Rule& rule, LayerChange& layer) const {
    const Rule adding = rule;
    for (std::size_t i = 0; i < layer.state.size(); ++i) {
      const double state = layer.observations[i] > 0 ? layer.state[i] : kNoBelief.state;
      layer.state[i] = static_cast<float>(adding.after({state}, layer.observation[i]).state);
    }
  }
};

template <AddingRule Rule>
void update_map(const Rule& rule, const FrameChange& change, const VoxelMap&) {
  const std::uint32_t stamp_ms = change.frame.stamp_ms;
  for_each_block(change, [&](std::size_t, const BlockObservation& seen, VoxelBlock& block) {
    change_layers(seen, stamp_ms, block.voxels,
                  [&](int, LayerChange& layer) { on_best_target(AddLayer{}, rule, layer); });
  });
}

template <AddingRule Rule>
requires KeepsIgnorance<Rule>
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

// Sorts by one coordinate and leaves those with the same one in their order, by counting.
void sort_along(int axis, const VoxelBounds& bounds, std::vector<Eigen::Vector3i>& voxels) {
  const int low = bounds.min[axis];
  std::vector<std::size_t> places(static_cast<std::size_t>(bounds.max[axis] - low) + 2, 0);
  for (const Eigen::Vector3i& voxel : voxels)
    ++places[static_cast<std::size_t>(voxel[axis] - low) + 1];
  std::partial_sum(places.begin(), places.end(), places.begin());
  std::vector<Eigen::Vector3i> sorted(voxels.size());
  for (const Eigen::Vector3i& voxel : voxels)
    sorted[places[static_cast<std::size_t>(voxel[axis] - low)]++] = voxel;
  voxels = std::move(sorted);
}

void sort_canonically(std::vector<Eigen::Vector3i>& voxels) {
  if (voxels.empty()) return;
  VoxelBounds bounds{voxels.front(), voxels.front()};
  for (const Eigen::Vector3i& voxel : voxels) {
    bounds.min = bounds.min.cwiseMin(voxel);
    bounds.max = bounds.max.cwiseMax(voxel);
  }
  for (const int axis : {2, 1, 0}) sort_along(axis, bounds, voxels);
}

FrameUpdate summary_of(const FrameObservation& observation) {
  FrameUpdate update;
  update.points_used = observation.points_used;
  std::size_t observed = 0, hit = 0;
  for (const BlockObservation& block : observation.blocks) {
    observed += block.observed.count();
    hit += block.hit.count();
  }
  update.hits.reserve(hit);
  for (const BlockObservation& block : observation.blocks)
    for_each_in(block.hit, [&](int i) { update.hits.push_back(voxel_at(block.index, i)); });
  sort_canonically(update.hits);
  update.hit_voxels = static_cast<int>(update.hits.size());
  update.free_voxels = static_cast<int>(observed) - update.hit_voxels;
  return update;
}

}  // namespace

FrameUpdate integrate(const DisparityImage& disparity, const RectifiedCamera& camera,
                      const SE3& T_world_camera, std::int64_t stamp_ns,
                      const OccupancyParams& params, int threads, VoxelMap& map) {
  const std::vector<int> rows = rows_read(sampling_steps(params, camera), disparity.height());
  const DisparityImage smooth = smoothed(disparity, params.smoothing, rows, threads);
  observe_floor(disparity, camera, T_world_camera, params, map);
  const FrameView frame = view_frame(smooth, camera, T_world_camera, stamp_ns, params, map);
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
