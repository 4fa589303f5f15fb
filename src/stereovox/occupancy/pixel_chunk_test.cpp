#include "stereovox/occupancy/pixel_chunk.h"

#include <gtest/gtest.h>

#include "stereovox/core/grid_geometry.h"
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

class Fixture {
 public:
  Fixture(OccupancyPreset preset, unsigned seed)
      : params(scene::params(preset)), scene_(scene::random_drive(seed, 1).front()) {}

  OccupancyParams params;

 private:
  scene::Frame scene_;
  RectifiedCamera camera_ = scene::camera();
  VoxelMap map_{params.voxel_size_m};

 public:
  FrameView frame = view_frame(scene_.disparity, camera_, scene_.T_world_camera, 0, params, map_);

  // Calls use(run, chunk) for runs from edge to edge.
  template <class Use>
  void for_each_chunk(int step, VectorTarget target, Use use) const {
    PixelChunk chunk;
    for (int v = 0; v < 48; ++v) {
      const PixelRun run{v, 1, step, 63 / step};
      measure_chunk(frame.disparity, pixel_limits(frame), run, chunk, target);
      use(run, chunk);
    }
  }
};

TEST(PixelChunk, SaysOfEachPixelWhatIsSaidOfItAloneOnEveryTarget) {
  for (const auto preset : {OccupancyPreset::literal, OccupancyPreset::corrected})
    for (const VectorTarget target : targets_here())
      for (const int step : {1, 3}) {
        const Fixture fixture(preset, 3);
        fixture.for_each_chunk(step, target, [&](const PixelRun& run, const PixelChunk& chunk) {
          for (int i = 0; i < run.count; ++i) expect_pixel(fixture.frame, run, chunk, i);
        });
      }
}

TEST(PixelChunk, TheVoxelsThatHoldThePointsMakeRunsOnEveryTarget) {
  int runs = 0, points = 0;
  for (const VectorTarget target : targets_here()) {
    const Fixture fixture(OccupancyPreset::corrected, 4);
    const double size_m = fixture.params.voxel_size_m;
    fixture.for_each_chunk(1, target, [&](const PixelRun&, const PixelChunk& chunk) {
      OwnVoxels own;
      find_own_voxels(chunk, size_m, own, target);
      for (std::size_t i = 0; i < PixelChunk::kSize; ++i) {
        const auto at = [&](std::size_t j) {
          return Eigen::Vector3d(chunk.p_world_m[0][j], chunk.p_world_m[1][j],
                                 chunk.p_world_m[2][j]);
        };
        const Eigen::Vector3i voxel = voxel_index_of(size_m, at(i));
        const bool marks = chunk.marks[i] != 0;
        ASSERT_EQ((own.marks >> i & 1) != 0, marks);
        if (!marks) continue;
        EXPECT_EQ(Eigen::Vector3i(own.voxel[0][i], own.voxel[1][i], own.voxel[2][i]), voxel);
        EXPECT_EQ(own.position[i], position_in_block(voxel));
        const bool goes_on = i > 0 && chunk.marks[i - 1] != 0 &&
                             voxel == voxel_index_of(size_m, at(i - 1)) &&
                             chunk.is_exact[i] == chunk.is_exact[i - 1];
        EXPECT_EQ((own.begins_run >> i & 1) != 0, !goes_on);
        ++points, runs += goes_on ? 0 : 1;
      }
    });
  }
  EXPECT_GT(points, 100);
  EXPECT_LT(runs, points);
}

TEST(PixelChunk, AxesSayTheSameOnEveryTarget) {
  const Fixture fixture(OccupancyPreset::corrected, 5);
  for (const VectorTarget target : targets_here())
    fixture.for_each_chunk(1, target, [&](const PixelRun&, const PixelChunk& chunk) {
      AxisLevels plain, fast;
      compute_levels(MinRampObservation{}, chunk, fixture.params.voxel_size_m, plain,
                     VectorTarget::portable);
      compute_levels(MinRampObservation{}, chunk, fixture.params.voxel_size_m, fast, target);
      EXPECT_EQ(fast.first, plain.first);
      ASSERT_EQ(fast.largest_count, plain.largest_count);
      for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t j = 0; j < plain.voxels[k].size(); ++j) {
          EXPECT_EQ(fast.voxels[k][j].level, plain.voxels[k][j].level);
          EXPECT_EQ(fast.voxels[k][j].is_own, plain.voxels[k][j].is_own);
          EXPECT_EQ(fast.voxels[k][j].place, plain.voxels[k][j].place);
          EXPECT_EQ(fast.voxels[k][j].changes_block, plain.voxels[k][j].changes_block);
        }
    });
}

}  // namespace
}  // namespace stereovox
