#include "stereovox/occupancy/frame_observation.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <type_traits>
#include <utility>

#include "stereovox/core/parallel.h"
#include "stereovox/occupancy/frame_evidence.h"
#include "stereovox/occupancy/free_space.h"
#include "stereovox/occupancy/masked_blocks.h"
#include "stereovox/occupancy/surface_marks.h"
#include "stereovox/occupancy/voxel_ray.h"

namespace stereovox {
namespace {

struct RowRange {
  int begin = 0, end = 0;
};

// Calls visit(run) for the sampling grid in these rows, at most a chunk at a time.
template <class Visit>
void for_each_run(const FrameView& frame, int step, RowRange rows, Visit visit) {
  const int width = frame.camera.pinhole.width;
  const int skipped = (rows.begin - first_sample(step) + step - 1) / step;
  const int first_row = first_sample(step) + std::max(0, skipped) * step;
  for (int v = first_row; v < rows.end; v += step)
    for (int u = first_sample(step); u < width; u += PixelChunk::kSize * step)
      visit(PixelRun{v, u, step, std::min(PixelChunk::kSize, (width - u + step - 1) / step)});
}

// Calls visit(point) for each measured pixel of the sampling grid in these rows.
template <class Visit>
void for_each_sample(const FrameView& frame, int step, RowRange rows, Visit visit) {
  for_each_run(frame, step, rows, [&](const PixelRun& run) {
    for (int i = 0; i < run.count; ++i)
      if (const auto point = measure_pixel(frame, run.first_u_px + i * step, run.v_px))
        visit(*point);
  });
}

int sample_count(int pixels, int step) { return (pixels - first_sample(step) + step - 1) / step; }

// Where the free ends of a chunk belong among those of the frame.
void store_reach(const FrameView& frame, const PixelRun& run, const PixelChunk& chunk,
                 ReachPyramid& reach) {
  const int step = frame.steps.ray_px;
  float* const row = reach.row(run.v_px / step) + run.first_u_px / step;
  for (int i = 0; i < run.count; ++i)
    row[i] = reach_of(chunk.free_end_m[static_cast<std::size_t>(i)], frame.params.voxel_size_m);
}

void store_reach(const FrameView& frame, RowRange rows, ReachPyramid& reach) {
  const PixelLimits limits = pixel_limits(frame);
  PixelChunk chunk;
  for_each_run(frame, frame.steps.ray_px, rows, [&](const PixelRun& run) {
    measure_chunk(frame.disparity, limits, run, chunk);
    store_reach(frame, run, chunk, reach);
  });
}

// What the points of some rows mark. With `reach` the free ends of their rays are stored as well:
// both read the same pixels.
template <class Mark>
void mark_rows(const FrameView& frame, RowRange rows, ReachPyramid* reach,
               SurfaceMarks<Mark>& marks) {
  const PixelLimits limits = pixel_limits(frame);
  PixelChunk chunk;
  AxisLevels levels;
  for_each_run(frame, frame.steps.surface_px, rows, [&](const PixelRun& run) {
    measure_chunk(frame.disparity, limits, run, chunk);
    if constexpr (std::is_same_v<Mark, PointsMark>)
      mark_points(frame, chunk, marks);
    else
      mark_levels(frame, chunk, levels, marks);
    if (reach != nullptr) store_reach(frame, run, chunk, *reach);
  });
}

void mark_rows(const FrameView& frame, RowRange rows, ReachPyramid* reach,
               SurfaceMarks<EvidenceMark>& marks) {
  for_each_run(frame, frame.steps.surface_px, rows,
               [&](const PixelRun& run) { mark_evidence(frame, run, marks); });
  if (reach != nullptr) store_reach(frame, rows, *reach);
}

// Step 3 by rays: the space that they cross.
void clear_rays(const FrameView& frame, RowRange rows, MaskedBlocks& free) {
  for_each_sample(frame, frame.steps.ray_px, rows, [&](const PointMeasurement& point) {
    const std::optional<Segment> segment = free_segment(frame, point);
    if (!segment) return;
    for_each_voxel_on_segment(segment->from, segment->to, frame.params.voxel_size_m,
                              [&](const Eigen::Vector3i& voxel) { free.set(voxel); });
  });
}

void clear_frustum(const FrameView& frame, MaskedBlocks& free) {
  const VoxelBounds bounds = frustum_bounds(frame);
  Eigen::Vector3i voxel;
  for (voxel.z() = bounds.min.z(); voxel.z() <= bounds.max.z(); ++voxel.z())
    for (voxel.y() = bounds.min.y(); voxel.y() <= bounds.max.y(); ++voxel.y())
      for (voxel.x() = bounds.min.x(); voxel.x() <= bounds.max.x(); ++voxel.x())
        if (is_in_frustum(frame, voxel)) free.set(voxel);
}

void clear_known(const VoxelMap& map, MaskedBlocks& free) {
  map.for_each_block(
      [&](const VoxelBlock& block) { free.insert(block.index, block.voxels.known()); });
}

// The bands of rows that threads share.
class Bands {
 public:
  Bands(const FrameView& frame, int threads)
      : height_(frame.disparity.height()),
        threads_(threads),
        count_(std::clamp(threads, 1, height_)) {}

  std::size_t count() const { return static_cast<std::size_t>(count_); }
  template <class Work>
  void for_each(Work work) const {
    parallel_for(0, count_, threads_, [&](int band) {
      work(static_cast<std::size_t>(band), RowRange{row_of(band), row_of(band + 1)});
    });
  }

 private:
  int row_of(int band) const { return static_cast<int>(std::int64_t{height_} * band / count_); }

  int height_, threads_, count_;
};

MaskedBlocks free_by_rays(const FrameView& frame, const Bands& bands) {
  std::vector<MaskedBlocks> free(bands.count());
  bands.for_each([&](std::size_t band, RowRange rows) { clear_rays(frame, rows, free[band]); });
  for (std::size_t band = 1; band < free.size(); ++band)
    for (std::size_t i = 0; i < free[band].indices().size(); ++i)
      free.front().insert(free[band].indices()[i], free[band].masks()[i]);
  return std::move(free.front());
}

MaskedBlocks free_by_projection(const FrameView& frame, ReachPyramid& reach, int threads) {
  reach.build();
  MaskedBlocks free;
  for (const CrossedBlock& block : crossed_blocks(free_space_view(frame), reach, threads))
    free.insert(block.index, block.voxels);
  return free;
}

MaskedBlocks free_within_view(const FrameView& frame, const VoxelMap& map) {
  MaskedBlocks free;
  clear_frustum(frame, free);
  if (frame.params.observed_set == ObservedSet::all) clear_known(map, free);
  return free;
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
  template <class Mark>
  void add(const Mark& mark) {
    const auto position = static_cast<std::size_t>(mark.position());
    is_touched_[position / VoxelMask::kBits][position % VoxelMask::kBits] = 1;
    mark.add_to(table_[position]);
  }

  template <class Observation>
  BlockObservation join(const FrameView& frame, const VoxelMask& free, const Eigen::Vector3i& index,
                        Observation observation) {
    BlockObservation out{.index = index, .observed = free, .hit = {}, .values = {}};
    const float min_hit = min_hit_observation(frame);
    const ExpectedPoints expected_points(frame);
    for_each_in(touched(), [&](int i) {
      VoxelEvidence& evidence = table_[static_cast<std::size_t>(i)];
      const double expected = expected_points.from(voxel_at(index, i));
      const float value = observation(evidence, expected, free.contains(i));
      evidence = {};
      if (value == kNothingSaid) return;
      if (out.values.empty()) out.values = values_where(free);
      out.values[static_cast<std::size_t>(i)] = value;
      out.observed.set(i);
      if (value > min_hit) out.hit.set(i);
    });
    is_touched_ = {};
    return out;
  }

 private:
  VoxelMask touched() const {
    VoxelMask mask;
    for (std::size_t i = 0; i < mask.words.size(); ++i)
      mask.words[i] = bits_of_bytes(is_touched_[i]);
    return mask;
  }

  std::vector<VoxelEvidence> table_ = std::vector<VoxelEvidence>(kVoxelsPerBlock);
  // Bytes: a bit needs its word first.
  std::array<std::array<std::uint8_t, VoxelMask::kBits>, kVoxelsPerBlock / VoxelMask::kBits>
      is_touched_{};
};

template <class Mark>
using MarkedBands = std::vector<SurfaceMarks<Mark>>;

// For each block of the frame and each band of rows: the number of that block in that band's marks.
class BandBlocks {
 public:
  template <class Mark>
  BandBlocks(const MarkedBands<Mark>& marked, MaskedBlocks& blocks) : bands_(marked.size()) {
    for (std::size_t band = 0; band < bands_; ++band)
      for (std::size_t i = 0; i < marked[band].blocks().size(); ++i) {
        const auto number = static_cast<std::size_t>(blocks.number_of(marked[band].blocks()[i]));
        if (numbers_.size() < (number + 1) * bands_) numbers_.resize((number + 1) * bands_, kNone);
        numbers_[number * bands_ + band] = i;
      }
    numbers_.resize(blocks.indices().size() * bands_, kNone);
  }

  template <class Mark, class Visit>
  void for_each_mark(const MarkedBands<Mark>& marked, std::size_t block, Visit visit) const {
    for (std::size_t band = 0; band < bands_; ++band)
      if (const std::size_t i = numbers_[block * bands_ + band]; i != kNone)
        marked[band].for_each_in_block(i, visit);
  }

 private:
  static constexpr std::size_t kNone = ~std::size_t{0};

  std::size_t bands_;
  std::vector<std::size_t> numbers_;
};

// Joins all blocks, shares of them on threads.
template <class Mark, class Observation>
std::vector<BlockObservation> join_blocks(const FrameView& frame, const MarkedBands<Mark>& marked,
                                          MaskedBlocks& blocks, int threads,
                                          Observation observation) {
  constexpr int kSharesPerThread = 8;  // blocks differ in their work
  const BandBlocks bands(marked, blocks);
  const int shares = threads > 1 ? threads * kSharesPerThread : 1;
  const int count = static_cast<int>(blocks.indices().size());
  std::vector<BlockObservation> joined(blocks.indices().size());
  parallel_for(0, shares, threads, [&](int share) {
    EvidenceTable table;
    const int end = static_cast<int>(std::int64_t{count} * (share + 1) / shares);
    for (int i = static_cast<int>(std::int64_t{count} * share / shares); i < end; ++i) {
      const auto at = static_cast<std::size_t>(i);
      bands.for_each_mark(marked, at, [&](const Mark& mark) { table.add(mark); });
      joined[at] = table.join(frame, blocks.masks()[at], blocks.indices()[at], observation);
    }
  });
  return joined;
}

template <class Mark>
FrameObservation observe_with(const FrameView& frame, const VoxelMap& map, int threads) {
  const Bands bands(frame, threads);
  const SamplingSteps& steps = frame.steps;
  const bool is_projected = frame.params.observed_set == ObservedSet::projected;
  const bool share_pixels = is_projected && steps.ray_px == steps.surface_px;
  ReachPyramid reach(is_projected ? sample_count(frame.disparity.width(), steps.ray_px) : 1,
                     is_projected ? sample_count(frame.disparity.height(), steps.ray_px) : 1);
  MarkedBands<Mark> marked(bands.count());
  bands.for_each([&](std::size_t band, RowRange rows) {
    mark_rows(frame, rows, share_pixels ? &reach : nullptr, marked[band]);
    if (is_projected && !share_pixels) store_reach(frame, rows, reach);
  });
  MaskedBlocks blocks = is_projected ? free_by_projection(frame, reach, threads)
                        : frame.params.observed_set == ObservedSet::raycast
                            ? free_by_rays(frame, bands)
                            : free_within_view(frame, map);

  FrameObservation out;
  for (const SurfaceMarks<Mark>& band : marked) out.points_used += band.points_used;
  with_observation(frame, [&](auto observation) {
    out.blocks = join_blocks(frame, marked, blocks, threads, observation);
  });
  out.index = blocks.index();
  return out;
}

}  // namespace

FrameObservation observe_frame(const FrameView& frame, const VoxelMap& map, int threads) {
  switch (sufficient_marks(frame)) {
    case MarkKind::points:
      return observe_with<PointsMark>(frame, map, threads);
    case MarkKind::levels:
      return observe_with<LevelMark>(frame, map, threads);
    case MarkKind::evidence:
      break;
  }
  return observe_with<EvidenceMark>(frame, map, threads);
}

}  // namespace stereovox
