#include "stereovox/occupancy/surface_marks.h"

#include <algorithm>
#include <bit>

#include "stereovox/occupancy/frame_evidence.h"
#include "stereovox/occupancy/voxel_mask.h"

namespace stereovox {
namespace {

using LevelMarks = PixelChunk::PerPixel<LevelMark>;

// The marks of the points for one voxel of each, and bit i when that of point i says something.
struct JoinAxes {
  [[gnu::always_inline]] void operator()(const AxisVoxels& x, const AxisVoxels& y,
                                         const AxisVoxels& z, const PixelChunk& chunk,
                                         LevelMarks& marks, std::uint64_t& says) const {
    PixelChunk::PerPixel<std::uint8_t> is_said;
    for (std::size_t i = 0; i < PixelChunk::kSize; ++i) {
      const std::uint8_t level_xy = std::min(x.level[i], y.level[i]);
      const std::uint8_t level = std::min(level_xy, z.level[i]);
      const std::uint8_t is_inside = x.is_own[i] & y.is_own[i] & z.is_own[i];
      marks[i] = {static_cast<unsigned>(x.place[i] | y.place[i] | z.place[i]), level, is_inside,
                  chunk.is_exact[i]};
      is_said[i] = (level > 0 ? 1 : 0) | is_inside;
    }
    says = bits_of_bytes(is_said);
  }
};

// Adds the marks of the voxels (x, y, z) of the points; successive ones mostly lie in one block.
void add_marks(const AxisLevels& levels, const Eigen::Array3i& which, const PixelChunk& chunk,
               SurfaceMarks<LevelMark>& to) {
  const auto voxels = [&](std::size_t k) -> const AxisVoxels& {
    return levels.voxels[k][static_cast<std::size_t>(which[static_cast<Eigen::Index>(k)])];
  };
  const AxisVoxels &x = voxels(0), &y = voxels(1), &z = voxels(2);
  LevelMarks marks;
  std::uint64_t rest = 0;
  on_best_target(JoinAxes{}, x, y, z, chunk, marks, rest);
  const std::uint64_t changes = x.changes_block | y.changes_block | z.changes_block;
  while (rest != 0) {
    const int first = std::countr_zero(rest);
    const auto at = static_cast<std::size_t>(first);
    const std::uint64_t changes_later = changes & ~std::uint64_t{1} << first;
    const std::uint64_t before_change =
        changes_later == 0 ? ~std::uint64_t{0} : (changes_later & -changes_later) - 1;
    auto& list = to.list_of(block_of(
        (Eigen::Array3i(levels.first[0][at], levels.first[1][at], levels.first[2][at]) + which)
            .matrix()));
    for (std::uint64_t here = rest & before_change; here != 0; here &= here - 1)
      list.add(marks[static_cast<std::size_t>(std::countr_zero(here))]);
    rest &= ~before_change;
  }
}

template <class Model>
void mark_by_model(const Model& model, const FrameView& frame, const PointMeasurement& point,
                   SurfaceMarks<EvidenceMark>& marks) {
  const double size_m = frame.params.voxel_size_m;
  const Eigen::Vector3i own = voxel_index_of(size_m, point.p_world);
  const bool is_exact_point = is_exact(frame, point);
  for_each_observed_voxel(model, point, size_m, [&](const Eigen::Vector3i& voxel, float evidence) {
    const bool is_inside = voxel == own;
    if (evidence <= 0.0F && !is_inside) return;
    marks.list_of(block_of(voxel))
        .add({static_cast<std::uint16_t>(position_in_block(voxel)), is_inside, is_exact_point,
              evidence});
  });
}

void mark_by_profile(const FrameView& frame, const PointMeasurement& point,
                     SurfaceMarks<EvidenceMark>& marks) {
  for_each_profiled_voxel(
      *frame.profile, frame, point, [&](const Eigen::Vector3i& voxel, float evidence) {
        marks.list_of(block_of(voxel))
            .add({static_cast<std::uint16_t>(position_in_block(voxel)), false, false, evidence});
      });
}

}  // namespace

MarkKind sufficient_marks(const FrameView& frame) {
  const OccupancyParams& params = frame.params;
  if (frame.profile != nullptr || !std::holds_alternative<RankUnion>(params.union_rule))
    return MarkKind::evidence;
  if (std::holds_alternative<PointObservation>(params.observation)) return MarkKind::points;
  const bool goes_by_axes =
      std::visit([]<class Model>(const Model&) { return AxisModel<Model>; }, params.observation);
  return goes_by_axes ? MarkKind::levels : MarkKind::evidence;
}

void mark_points(const FrameView& frame, const PixelChunk& chunk, SurfaceMarks<PointsMark>& marks) {
  OwnVoxels own;
  find_own_voxels(chunk, frame.params.voxel_size_m, own);
  marks.points_used += std::popcount(own.marks);
  for (std::uint64_t rest = own.begins_run; rest != 0; rest &= rest - 1) {
    const int first = std::countr_zero(rest);
    const auto at = static_cast<std::size_t>(first);
    const std::uint64_t later = ~std::uint64_t{1} << first;
    const int end = std::countr_zero((own.begins_run | ~own.marks) & later);
    marks.list_of(block_of({own.voxel[0][at], own.voxel[1][at], own.voxel[2][at]}))
        .add({static_cast<std::uint16_t>(own.position[at]), static_cast<std::uint8_t>(end - first),
              chunk.is_exact[at] != 0});
  }
}

void mark_levels(const FrameView& frame, const PixelChunk& chunk, AxisLevels& levels,
                 SurfaceMarks<LevelMark>& marks) {
  const std::uint64_t marking = bits_of_bytes(chunk.marks);
  if (marking == 0) return;
  marks.points_used += std::popcount(marking);
  std::visit(
      [&]<class Model>(const Model& model) {
        if constexpr (AxisModel<Model>)
          compute_levels(model, chunk, frame.params.voxel_size_m, levels);
      },
      frame.params.observation);
  Eigen::Array3i which;
  for (which.z() = 0; which.z() < levels.largest_count[2]; ++which.z())
    for (which.y() = 0; which.y() < levels.largest_count[1]; ++which.y())
      for (which.x() = 0; which.x() < levels.largest_count[0]; ++which.x())
        add_marks(levels, which, chunk, marks);
}

void mark_evidence(const FrameView& frame, const PixelRun& run, SurfaceMarks<EvidenceMark>& marks) {
  for (int i = 0; i < run.count; ++i) {
    const auto point = measure_pixel(frame, run.first_u_px + i * run.step_px, run.v_px);
    if (!point || !marks_surface(frame, *point)) continue;
    ++marks.points_used;
    if (frame.profile != nullptr)
      mark_by_profile(frame, *point, marks);
    else
      std::visit([&](const auto& model) { mark_by_model(model, frame, *point, marks); },
                 frame.params.observation);
  }
}

}  // namespace stereovox
