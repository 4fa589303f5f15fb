#include "stereovox/occupancy/surface_marks.h"

#include <algorithm>

#include "stereovox/occupancy/frame_evidence.h"

namespace stereovox {
namespace {

// The voxels near one point: [begin, end) along each axis of the world.
struct NearVoxels {
  Eigen::Vector3i begin, end;
};

// Calls visit(block, part) for each block that has a part of the voxels.
template <class Visit>
void for_each_block_of(const NearVoxels& near, Visit visit) {
  const auto block_end = [](int voxel) { return (voxel | (kBlockSide - 1)) + 1; };
  NearVoxels part;
  for (int z = near.begin.z(); z < near.end.z(); z = part.end.z()) {
    part.begin.z() = z, part.end.z() = std::min(near.end.z(), block_end(z));
    for (int y = near.begin.y(); y < near.end.y(); y = part.end.y()) {
      part.begin.y() = y, part.end.y() = std::min(near.end.y(), block_end(y));
      for (int x = near.begin.x(); x < near.end.x(); x = part.end.x()) {
        part.begin.x() = x, part.end.x() = std::min(near.end.x(), block_end(x));
        visit(block_of(part.begin), part);
      }
    }
  }
}

// What a chunk says of the voxels around its point `i`.
class PointLevels {
 public:
  PointLevels(const PixelChunk& chunk, const AxisLevels& levels, std::size_t i)
      : levels_(levels), i_(i), is_exact_(chunk.is_exact[i] != 0) {}

  NearVoxels near() const {
    NearVoxels near;
    for (int k = 0; k < 3; ++k) {
      near.begin[k] = first(k);
      near.end[k] = first(k) + levels_.count[static_cast<std::size_t>(k)][i_];
    }
    return near;
  }
  Eigen::Vector3i first_block() const { return block_of({first(0), first(1), first(2)}); }
  bool is_in_one_block() const { return levels_.is_in_one_block[i_] != 0; }

  // The part of the voxels that lies in the open block; `position`: of its first voxel.
  void mark(const NearVoxels& part, int position, SurfaceMarks<LevelMark>& marks) const {
    for (int z = part.begin.z(); z < part.end.z(); ++z, position += kBlockSide * kBlockSide) {
      const int level_z = level(2, z);
      for (int y = part.begin.y(), row = position; y < part.end.y(); ++y, row += kBlockSide)
        mark_row(y, z, std::min(level_z, level(1, y)), part, row, marks);
    }
  }

 private:
  int first(int axis) const { return levels_.first[static_cast<std::size_t>(axis)][i_]; }
  int level(int axis, int voxel) const {
    return levels_
        .levels[static_cast<std::size_t>(axis)][static_cast<std::size_t>(voxel - first(axis))][i_];
  }
  void mark_row(int y, int z, int level_yz, const NearVoxels& part, int position,
                SurfaceMarks<LevelMark>& marks) const {
    const bool is_own_row = y == levels_.own[1][i_] && z == levels_.own[2][i_];
    if (level_yz == 0 && !is_own_row) return;
    for (int x = part.begin.x(); x < part.end.x(); ++x, ++position) {
      const int level_here = std::min(level_yz, level(0, x));
      const bool is_inside = is_own_row && x == levels_.own[0][i_];
      if (level_here > 0)
        marks.add({position, level_here - 1, is_inside, is_exact_});
      else if (is_inside)
        marks.add({position, 0, true, false});
    }
  }

  const AxisLevels& levels_;
  std::size_t i_;
  bool is_exact_;
};

template <class Model>
void mark_by_model(const Model& model, const FrameView& frame, const PointMeasurement& point,
                   SurfaceMarks<EvidenceMark>& marks) {
  const double size_m = frame.params.voxel_size_m;
  const Eigen::Vector3i own = voxel_index_of(size_m, point.p_world);
  const bool is_exact_point = is_exact(frame, point);
  for_each_observed_voxel(model, point, size_m, [&](const Eigen::Vector3i& voxel, float evidence) {
    const bool is_inside = voxel == own;
    if (evidence <= 0.0F && !is_inside) return;
    marks.open(block_of(voxel));
    marks.add({static_cast<std::uint16_t>(position_in_block(voxel)), is_inside, is_exact_point,
               evidence});
  });
}

void mark_by_profile(const FrameView& frame, const PointMeasurement& point,
                     SurfaceMarks<EvidenceMark>& marks) {
  for_each_profiled_voxel(
      *frame.profile, frame, point, [&](const Eigen::Vector3i& voxel, float evidence) {
        marks.open(block_of(voxel));
        marks.add({static_cast<std::uint16_t>(position_in_block(voxel)), false, false, evidence});
      });
}

}  // namespace

bool levels_suffice(const FrameView& frame) {
  const bool goes_by_axes = std::visit([]<class Model>(const Model&) { return AxisModel<Model>; },
                                       frame.params.observation);
  return frame.profile == nullptr && goes_by_axes &&
         std::holds_alternative<RankUnion>(frame.params.union_rule);
}

void mark_levels(const FrameView& frame, const PixelChunk& chunk, AxisLevels& levels,
                 SurfaceMarks<LevelMark>& marks) {
  std::visit(
      [&]<class Model>(const Model& model) {
        if constexpr (AxisModel<Model>)
          compute_levels(model, chunk, frame.params.voxel_size_m, levels);
      },
      frame.params.observation);
  for (std::size_t i = 0; i < static_cast<std::size_t>(chunk.count); ++i) {
    if (chunk.marks[i] == 0) continue;
    ++marks.points_used;
    const PointLevels point(chunk, levels, i);
    if (levels.only_level[i] > 0) {
      marks.open(point.first_block());
      marks.add({levels.first_position[i], levels.only_level[i] - 1, levels.is_only_own[i] != 0,
                 chunk.is_exact[i] != 0});
      continue;
    }
    if (point.is_in_one_block()) {
      marks.open(point.first_block());
      point.mark(point.near(), levels.first_position[i], marks);
      continue;
    }
    for_each_block_of(point.near(), [&](const Eigen::Vector3i& block, const NearVoxels& part) {
      marks.open(block);
      point.mark(part, position_in_block(part.begin), marks);
    });
  }
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
