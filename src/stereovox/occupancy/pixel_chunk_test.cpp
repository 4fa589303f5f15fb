#include "stereovox/occupancy/pixel_chunk.h"

#include <gtest/gtest.h>

#include "stereovox/occupancy/scene_for_test.h"

namespace stereovox {
namespace {

void expect_pixel(const FrameView& frame, const PixelRun& run, const PixelChunk& chunk, int i) {
  const auto at = static_cast<std::size_t>(i);
  const int u = run.first_u_px + i * run.step_px;
  const auto point = measure_pixel(frame, u, run.v_px);
  EXPECT_EQ(chunk.free_end_m[at], free_end_m(frame, u, run.v_px));
  const bool marks = point && marks_surface(frame, *point);
  ASSERT_EQ(chunk.marks[at] != 0, marks) << "pixel " << u << ", " << run.v_px;
  if (!marks) return;
  EXPECT_EQ(chunk.is_exact[at] != 0, is_exact(frame, *point));
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    EXPECT_EQ(chunk.p_world_m[k][at], point->p_world[axis]);
    EXPECT_EQ(chunk.variance_m2[k][at], point->covariance_world(axis, axis));
  }
}

TEST(PixelChunk, SaysOfEachPixelWhatIsSaidOfItAlone) {
  for (const auto preset : {OccupancyPreset::literal, OccupancyPreset::corrected})
    for (const int step : {1, 3}) {
      const OccupancyParams params = scene::params(preset);
      const scene::Frame scene = scene::random_drive(3, 1).front();
      const RectifiedCamera camera = scene::camera();
      VoxelMap map(params.voxel_size_m);
      const FrameView frame =
          view_frame(scene.disparity, camera, scene.T_world_camera, 0, params, map);
      PixelChunk chunk;
      for (int v = 0; v < 48; ++v) {
        const PixelRun run{v, 1, step, 63 / step};
        measure_chunk(frame, run, chunk);
        for (int i = 0; i < run.count; ++i) expect_pixel(frame, run, chunk, i);
      }
    }
}

}  // namespace
}  // namespace stereovox
