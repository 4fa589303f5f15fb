// Many pixels of one image row measured at once. Says bit for bit what measure_pixel,
// marks_surface, is_exact and the free margin (frame_view.h) say of each.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "stereovox/occupancy/frame_view.h"
#include "stereovox/occupancy/vector_target.h"

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
  PerPixel<std::uint8_t> marks, is_exact;                  // 1 or 0; not exact what marks nothing
  // Where on the ray the space ceases to be free, in metres from the camera; 0 without measurement.
  PerPixel<float> free_end_m;
};

// What decides over the pixels of a frame.
struct PixelLimits {
  MeasuringFrame measuring;
  FreeMargin margin;
  double min_depth_m, max_depth_m, min_z_m, max_z_m, max_sigma_m, exact_sigma_m, max_clearing_m;
};

PixelLimits pixel_limits(const FrameView& frame);

void measure_chunk(const DisparityImage& image, const PixelLimits& limits, const PixelRun& run,
                   PixelChunk& chunk, VectorTarget target = best_target());

// The voxels that hold the points. Successive points in the same voxel make a run.
struct OwnVoxels {
  std::array<PixelChunk::PerPixel<std::int32_t>, 3> voxel;
  PixelChunk::PerPixel<std::int32_t> position;  // in the block
  // Bit i: point i marks a surface, and it does so in another voxel than the one before or is more
  // or less exact than that.
  std::uint64_t marks, begins_run;
};

void find_own_voxels(const PixelChunk& chunk, double voxel_size_m, OwnVoxels& out,
                     VectorTarget target = best_target());

// What the points say along each axis of the voxels near them, for a model that goes by axes.
// Point i speaks for the voxels first[k][i] + j along axis k; its evidence for voxel (x, y, z) is
// the least of the three.
struct AxisVoxels {                           // the j-th of each point
  PixelChunk::PerPixel<std::uint8_t> level;   // what is said of it: 0 nothing, else 1 + the level
  PixelChunk::PerPixel<std::uint8_t> is_own;  // 1: it holds the point, as far as this axis goes
  PixelChunk::PerPixel<std::uint16_t> place;  // its part of the position in the block
  // Bit i: it lies in another block than that of the point before.
  std::uint64_t changes_block;
};

struct AxisLevels {
  std::array<PixelChunk::PerPixel<std::int32_t>, 3> first;
  std::array<int, 3> largest_count{};  // of voxels along an axis
  std::array<std::vector<AxisVoxels>, 3> voxels;
};

void compute_levels(const MinRampObservation& model, const PixelChunk& chunk, double voxel_size_m,
                    AxisLevels& out, VectorTarget target = best_target());

}  // namespace stereovox
