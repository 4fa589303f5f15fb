#include "stereovox/occupancy/frame_observation.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "stereovox/core/parallel.h"
#include "stereovox/occupancy/frame_evidence.h"
#include "stereovox/occupancy/voxel_ray.h"

namespace stereovox {
namespace {

// Evidence of one point for one voxel.
struct Mark {
  std::uint16_t position = 0;  // in the block
  bool is_inside = false;      // the point lies in this voxel
  bool is_exact = false;       // its error is small against the voxel
  float evidence = 0.0F;
};

struct MarkedBlock {
  std::vector<Mark> marks;
  VoxelMask free;
};

// Collects marks and free voxels by block. Consecutive voxels mostly lie in the same block.
class MarkedBlocks {
 public:
  MarkedBlock& block_with(const Eigen::Vector3i& voxel) {
    const Eigen::Vector3i block = block_of(voxel);
    if (last_ == BlockIndex::kNone || block != last_block_) {
      last_block_ = block;
      last_ = number_of(block);
    }
    return blocks[static_cast<std::size_t>(last_)];
  }

  void append(MarkedBlocks&& other) {
    points_used += other.points_used;
    for (std::size_t i = 0; i < other.blocks.size(); ++i) {
      MarkedBlock& block = blocks[static_cast<std::size_t>(number_of(other.indices[i]))];
      block.free |= other.blocks[i].free;
      block.marks.insert(block.marks.end(), other.blocks[i].marks.begin(),
                         other.blocks[i].marks.end());
    }
  }

  BlockIndex index;
  std::vector<Eigen::Vector3i> indices;
  std::vector<MarkedBlock> blocks;
  int points_used = 0;

 private:
  int number_of(const Eigen::Vector3i& block) {
    const int number = index.find_or_insert(block);
    if (number == static_cast<int>(blocks.size())) {
      indices.push_back(block);
      blocks.emplace_back();
    }
    return number;
  }

  Eigen::Vector3i last_block_ = Eigen::Vector3i::Zero();
  int last_ = BlockIndex::kNone;
};

struct RowRange {
  int begin = 0, end = 0;
};

// Calls visit(point) for each measured pixel of the sampling grid in these rows.
template <class Visit>
void for_each_sample(const FrameView& frame, int step, RowRange rows, Visit visit) {
  const int skipped = (rows.begin - first_sample(step) + step - 1) / step;
  const int first_row = first_sample(step) + std::max(0, skipped) * step;
  for (int v = first_row; v < rows.end; v += step)
    for (int u = first_sample(step); u < frame.camera.pinhole.width; u += step)
      if (const std::optional<PointMeasurement> point = measure_pixel(frame, u, v)) visit(*point);
}

// Step 2, first half: which voxels the points speak for.
template <class Model>
void mark_surfaces(const Model& model, const FrameView& frame, RowRange rows, MarkedBlocks& out) {
  const double size_m = frame.params.voxel_size_m;
  for_each_sample(frame, frame.steps.surface_px, rows, [&](const PointMeasurement& point) {
    if (!marks_surface(frame, point)) return;
    ++out.points_used;
    const Eigen::Vector3i own = voxel_index_of(size_m, point.p_world);
    const bool is_exact_point = is_exact(frame, point);
    for_each_observed_voxel(model, point, size_m,
                            [&](const Eigen::Vector3i& voxel, float evidence) {
                              const bool is_inside = voxel == own;
                              if (evidence > 0.0F || is_inside)
                                out.block_with(voxel).marks.push_back(
                                    {static_cast<std::uint16_t>(position_in_block(voxel)),
                                     is_inside, is_exact_point, evidence});
                            });
  });
}

// The same along the rays, when the update rule has a profile.
void mark_profiles(const SurfaceProfile& profile, const FrameView& frame, RowRange rows,
                   MarkedBlocks& out) {
  for_each_sample(frame, frame.steps.surface_px, rows, [&](const PointMeasurement& point) {
    if (!marks_surface(frame, point)) return;
    ++out.points_used;
    for_each_profiled_voxel(
        profile, frame, point, [&](const Eigen::Vector3i& voxel, float evidence) {
          out.block_with(voxel).marks.push_back(
              {static_cast<std::uint16_t>(position_in_block(voxel)), false, false, evidence});
        });
  });
}

// Step 3: the space that the rays cross.
void clear_rays(const FrameView& frame, RowRange rows, MarkedBlocks& out) {
  for_each_sample(frame, frame.steps.ray_px, rows, [&](const PointMeasurement& point) {
    const std::optional<Segment> segment = free_segment(frame, point);
    if (!segment) return;
    for_each_voxel_on_segment(segment->from, segment->to, frame.params.voxel_size_m,
                              [&](const Eigen::Vector3i& voxel) {
                                out.block_with(voxel).free.set(position_in_block(voxel));
                              });
  });
}

MarkedBlocks mark_rows(const FrameView& frame, RowRange rows) {
  MarkedBlocks marked;
  if (frame.profile != nullptr)
    mark_profiles(*frame.profile, frame, rows, marked);
  else
    std::visit([&](const auto& model) { mark_surfaces(model, frame, rows, marked); },
               frame.params.observation);
  if (frame.params.observed_set == ObservedSet::raycast) clear_rays(frame, rows, marked);
  return marked;
}

void clear_frustum(const FrameView& frame, MarkedBlocks& out) {
  const VoxelBounds bounds = frustum_bounds(frame);
  Eigen::Vector3i voxel;
  for (voxel.z() = bounds.min.z(); voxel.z() <= bounds.max.z(); ++voxel.z())
    for (voxel.y() = bounds.min.y(); voxel.y() <= bounds.max.y(); ++voxel.y())
      for (voxel.x() = bounds.min.x(); voxel.x() <= bounds.max.x(); ++voxel.x())
        if (is_in_frustum(frame, voxel)) out.block_with(voxel).free.set(position_in_block(voxel));
}

void clear_known(const VoxelMap& map, MarkedBlocks& out) {
  for (const VoxelBlock* const block : map.sorted_blocks())
    for (int i = 0; i < kVoxelsPerBlock; ++i)
      if (is_known(block->voxels[static_cast<std::size_t>(i)]))
        out.block_with(voxel_at(block->index, i)).free.set(i);
}

MarkedBlocks mark_frame(const FrameView& frame, const VoxelMap& map, int threads) {
  const int bands = std::max(1, std::min(threads, frame.disparity.height()));
  std::vector<MarkedBlocks> marked(static_cast<std::size_t>(bands));
  const auto row_of = [&](int band) { return frame.disparity.height() * band / bands; };
  parallel_for(0, bands, threads, [&](int band) {
    marked[static_cast<std::size_t>(band)] = mark_rows(frame, {row_of(band), row_of(band + 1)});
  });
  MarkedBlocks all = std::move(marked.front());
  for (std::size_t band = 1; band < marked.size(); ++band) all.append(std::move(marked[band]));
  if (frame.params.observed_set != ObservedSet::raycast) clear_frustum(frame, all);
  if (frame.params.observed_set == ObservedSet::all) clear_known(map, all);
  return all;
}

std::vector<float> values_where(const VoxelMask& observed) {
  std::vector<float> values(kVoxelsPerBlock, kUnobserved);
  for_each_in(observed, [&](int i) { values[static_cast<std::size_t>(i)] = 0.0F; });
  return values;
}

// Steps 2 (second half) and 4 for blocks: joins the points of each voxel into O_t. Keeps its table
// of evidence clean between blocks, because clearing it costs more than filling it.
class EvidenceTable {
 public:
  // `observation`(evidence, expected points, whether rays crossed the voxel) is O_t.
  template <class Observation>
  BlockObservation join(const FrameView& frame, const MarkedBlock& marked,
                        const Eigen::Vector3i& index, Observation observation) {
    BlockObservation out{.index = index, .observed = marked.free, .hit = {}, .values = {}};
    const float min_hit = min_hit_observation(frame);
    for (const Mark& mark : marked.marks) {
      touched_.set(mark.position);
      table_[mark.position].add(mark.evidence, mark.is_inside, mark.is_exact);
    }
    for_each_in(touched_, [&](int i) {
      VoxelEvidence& evidence = table_[static_cast<std::size_t>(i)];
      const double expected = expected_points(frame, voxel_at(index, i));
      const float value = observation(evidence, expected, marked.free.contains(i));
      evidence = {};
      if (value == kNothingSaid) return;
      if (out.values.empty()) out.values = values_where(marked.free);
      out.values[static_cast<std::size_t>(i)] = value;
      out.observed.set(i);
      if (value > min_hit) out.hit.set(i);
    });
    touched_ = {};
    return out;
  }

 private:
  std::vector<VoxelEvidence> table_ = std::vector<VoxelEvidence>(kVoxelsPerBlock);
  VoxelMask touched_;
};

// Joins all blocks, shares of them on threads.
template <class Observation>
std::vector<BlockObservation> join_blocks(const FrameView& frame, const MarkedBlocks& marked,
                                          int threads, Observation observation) {
  constexpr int kSharesPerThread = 8;  // blocks differ in their work
  const int shares = threads > 1 ? threads * kSharesPerThread : 1;
  const int count = static_cast<int>(marked.blocks.size());
  std::vector<BlockObservation> joined(marked.blocks.size());
  parallel_for(0, shares, threads, [&](int share) {
    EvidenceTable table;
    const int end = static_cast<int>(std::int64_t{count} * (share + 1) / shares);
    for (int i = static_cast<int>(std::int64_t{count} * share / shares); i < end; ++i) {
      const auto at = static_cast<std::size_t>(i);
      joined[at] = table.join(frame, marked.blocks[at], marked.indices[at], observation);
    }
  });
  return joined;
}

}  // namespace

FrameObservation observe_frame(const FrameView& frame, const VoxelMap& map, int threads) {
  MarkedBlocks marked = mark_frame(frame, map, threads);
  FrameObservation out;
  out.points_used = marked.points_used;
  with_observation(frame, [&](auto observation) {
    out.blocks = join_blocks(frame, marked, threads, observation);
  });
  out.index = std::move(marked.index);
  return out;
}

}  // namespace stereovox
