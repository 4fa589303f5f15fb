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

// --- Ranges that are left open. ---

OccupancyParams open_ranges(double voxel_size_m) {
  OccupancyParams params;
  params.voxel_size_m = voxel_size_m;
  params.max_sigma_half_voxels = 4.0;
  params.error_model.min_sigma_disparity_px = 0.25;
  return params;
}

TEST(Ranges, OfASmallRigAreThoseOfRooms) {
  for (const double voxel_size_m : {0.05, 0.25}) {
    const OccupancyParams ranged =
        with_ranges(open_ranges(voxel_size_m), camera_with_focal_length(525));
    EXPECT_EQ(ranged.max_depth_m, 8.0);
    EXPECT_EQ(ranged.max_clearing_m, 5.0);
  }
}

TEST(Ranges, OfAWideRigEndWhereDisparitiesAreSmall) {
  const RectifiedCamera car = {{1226, 370, 707.0, 707.0, 613.0, 185.0}, 0.54};
  const OccupancyParams coarse = with_ranges(open_ranges(2.0), car);
  EXPECT_DOUBLE_EQ(car.disparity_px(coarse.max_depth_m), 8.0);
  EXPECT_DOUBLE_EQ(car.disparity_px(coarse.max_clearing_m), 13.0);
}

TEST(Ranges, OfFreeSpaceEndWhereTheErrorIsTwoVoxels) {
  const RectifiedCamera car = {{1226, 370, 707.0, 707.0, 613.0, 185.0}, 0.54};
  const double range_m = with_ranges(open_ranges(0.05), car).max_clearing_m;
  EXPECT_NEAR(range_m * range_m * 0.25 / (707.0 * 0.54), 2 * 0.05, 1e-12);
}

TEST(Ranges, OfSurfacesEndWhereTheErrorExceedsALimit) {
  const RectifiedCamera car = {{1226, 370, 707.0, 707.0, 613.0, 185.0}, 0.54};
  const auto sigma_at_end_m = [&](double max_sigma_m) {
    OccupancyParams params = open_ranges(0.05);
    params.max_sigma_m = max_sigma_m;
    const double range_m = with_ranges(params, car).max_depth_m;
    return range_m * range_m * 0.25 / (707.0 * 0.54);
  };
  EXPECT_NEAR(sigma_at_end_m(0.2), 4 * 0.025, 1e-12);
  EXPECT_NEAR(sigma_at_end_m(0.07), 0.07, 1e-12);
  EXPECT_NEAR(sigma_at_end_m(0.045), 0.045, 1e-12);
}

TEST(Ranges, ErrorsBelowHalfAVoxelAlwaysCount) {
  OccupancyParams params = open_ranges(0.05);
  params.max_sigma_m = 0.01;
  EXPECT_EQ(max_sigma_m(params), 0.025);
}

TEST(Ranges, AnOpenLimitOfTheErrorSuitsTheCamera) {
  OccupancyParams params = open_ranges(0.25);
  params.max_sigma_m = 0.0;
  const RectifiedCamera weak = {{320, 240, 250.0, 250.0, 159.5, 119.5}, 0.08},
                        usual = {{640, 480, 525.0, 525.0, 319.5, 239.5}, 0.12},
                        wide = {{640, 480, 700.0, 700.0, 319.5, 239.5}, 0.5};
  EXPECT_DOUBLE_EQ(with_ranges(params, weak).max_sigma_m, 16.0 * 0.5 / 20.0);
  EXPECT_NEAR(with_ranges(params, usual).max_sigma_m, 0.13, 0.001);
  EXPECT_DOUBLE_EQ(with_ranges(params, wide).max_sigma_m, 350.0 * 0.25 / (11.0 * 11.0));
}

TEST(Ranges, StayAsGiven) {
  const OccupancyParams given =
      with_ranges(params_with_steps(0, 0), camera_with_focal_length(5000));
  EXPECT_EQ(given.max_clearing_m, 5.0);
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
