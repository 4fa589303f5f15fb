// Many pixels of one image row measured at once. Says bit for bit what measure_pixel,
// marks_surface, is_exact and the free margin (frame_view.h) say of each.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "stereovox/occupancy/frame_view.h"

namespace stereovox {

// Every `step`-th pixel of row `v_px` from `first_u_px` on, `count` of them.
struct PixelRun {
  int v_px = 0, first_u_px = 0, step_px = 1, count = 0;
};

struct PixelChunk {
  static constexpr int kSize = 64;
  template <class Value>
  using PerPixel = std::array<Value, kSize>;

  int count = 0;
  std::array<PerPixel<double>, 3> p_world_m, variance_m2;  // 0 where no surface is marked
  PerPixel<std::uint8_t> marks, is_exact;                  // 1 or 0
  // Where on the ray the space ceases to be free, in metres from the camera; 0 without measurement.
  PerPixel<float> free_end_m;
};

void measure_chunk(const FrameView& frame, const PixelRun& run, PixelChunk& chunk);

// What the points say along each axis of the voxels near them, for a model that goes by axes.
// Point i speaks for the voxels first[k][i] + j along axis k, j < count[k][i]; its evidence for
// voxel (x, y, z) is the least of the three.
struct AxisLevels {
  // Largest count of the chunk, and what it says of the j-th voxel: 0 nothing, else 1 + the level.
  std::array<int, 3> largest_count{};
  std::array<PixelChunk::PerPixel<std::int32_t>, 3> first, count, own;  // own: holds the point
  std::array<std::vector<PixelChunk::PerPixel<std::uint8_t>>, 3> levels;
  // Where the first of its voxels lies in its block, and whether the others lie in that block too.
  PixelChunk::PerPixel<std::int32_t> first_position, is_in_one_block;
  // For a point that speaks for one voxel only: its level as above, and whether it lies in it; -1
  // for others.
  PixelChunk::PerPixel<std::int32_t> only_level, is_only_own;
};

void compute_levels(const MinRampObservation& model, const PixelChunk& chunk, double voxel_size_m,
                    AxisLevels& out);
void compute_levels(const PointObservation& model, const PixelChunk& chunk, double voxel_size_m,
                    AxisLevels& out);

}  // namespace stereovox
