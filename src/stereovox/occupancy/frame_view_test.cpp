#include "stereovox/occupancy/frame_view.h"

#include <gtest/gtest.h>

namespace stereovox {
namespace {

RectifiedCamera camera_with_focal_length(double f_px) {
  return {{640, 480, f_px, f_px, 320.0, 240.0}, 0.12};
}

OccupancyParams params_with_steps(int pixel_step, int ray_step_px) {
  OccupancyParams params;
  params.voxel_size_m = 0.05;
  params.max_clearing_m = 5.0;
  params.pixel_step = pixel_step;
  params.ray_step_px = ray_step_px;
  return params;
}

TEST(SamplingSteps, AutomaticRaysAreAVoxelApartWhereTheyEndAndSurfacesTwiceAsDense) {
  const SamplingSteps fine = sampling_steps(params_with_steps(0, 0), camera_with_focal_length(525));
  EXPECT_EQ(fine.ray_px, 6) << "0.05 m at 5 m are 5.25 px";
  EXPECT_EQ(fine.surface_px, 3);
  const SamplingSteps coarse =
      sampling_steps(params_with_steps(0, 0), camera_with_focal_length(60));
  EXPECT_EQ(coarse.ray_px, 1);
  EXPECT_EQ(coarse.surface_px, 1);
}

TEST(SamplingSteps, GivenStepsAreKept) {
  const SamplingSteps steps =
      sampling_steps(params_with_steps(2, 9), camera_with_focal_length(525));
  EXPECT_EQ(steps.surface_px, 2);
  EXPECT_EQ(steps.ray_px, 9);
}

TEST(SamplingSteps, RowsOfSurfacesAndOfRaysAreRead) {
  EXPECT_EQ(rows_read({.surface_px = 2, .ray_px = 3}, 8), (std::vector<int>{1, 3, 4, 5, 7}));
}

}  // namespace
}  // namespace stereovox
