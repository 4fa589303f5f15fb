#include "stereovox/baselines/octomap_baseline.h"

#include <gtest/gtest.h>

#include "stereovox/core/error.h"
#include "stereovox/navmap/drawn_map_for_test.h"

namespace stereovox {
namespace {

constexpr double kOctomapCell_m = 0.25;
const GridGeometry kOctomapGrid{
    .origin_m = {0, -0.5}, .cell_size_m = kOctomapCell_m, .width = 10, .height = 4};

RectifiedCamera small_camera() {
  return {
      .pinhole =
          {.width = 21, .height = 21, .fx_px = 60.0, .fy_px = 60.0, .cx_px = 10.0, .cy_px = 10.0},
      .baseline_m = 0.12};
}

// Looks along the world's x axis from 0.6 m above the floor.
SE3 forward_pose() {
  Eigen::Matrix3d R;
  R << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return {Eigen::Quaterniond(R), {0.1, 0.01, 0.6}};
}

DisparityImage wall_at(double depth_m) {
  const RectifiedCamera camera = small_camera();
  const auto d = static_cast<float>(camera.disparity_px(depth_m));
  return {cv::Mat1f(21, 21, d), cv::Mat1f(21, 21, 0.25F)};
}

OctomapBaselineParams test_params() {
  OctomapBaselineParams params;
  params.voxel_size_m = kOctomapCell_m;
  return params;
}

OccupancyGrid2D map_of(const OctomapBaselineParams& params, double depth_m) {
  OctomapBaseline octomap(params);
  octomap.integrate(wall_at(depth_m), small_camera(), forward_pose());
  return octomap.map(kOctomapGrid, 0.0);
}

TEST(OctomapBaseline, WallIsOccupiedAndTheSpaceBeforeItFree) {
  EXPECT_EQ(drawing_of(map_of(test_params(), 1.75)), (Drawing{"??????.#??",  //
                                                              ".......#??",  //
                                                              ".......#??",  //
                                                              "??????.#??"}));
}

TEST(OctomapBaseline, PointsBeyondTheRangeClearUpToItAndMarkNothing) {
  OctomapBaselineParams params = test_params();
  params.max_range_m = 1.0;
  const Drawing map = drawing_of(map_of(params, 1.75));
  EXPECT_EQ(map[1].substr(0, 5), ".....");
  EXPECT_EQ(map[1].substr(5), "?????");
}

TEST(OctomapBaseline, SensorModelIsTheLibrarysOwn) {
  const OccupancyGrid2D map = map_of(test_params(), 1.75);
  EXPECT_NEAR(map.states[map.position_of({7, 2})], 0.7, 1e-5);
  EXPECT_NEAR(map.states[map.position_of({3, 2})], 0.4, 1e-5);
}

TEST(OctomapBaseline, OnlyVoxelsOfTheHeightBandCount) {
  OctomapBaselineParams params = test_params();
  params.min_height_m = 1.0;
  EXPECT_EQ(drawing_of(map_of(params, 1.75)), Drawing(4, "??????????"));
}

TEST(OctomapBaseline, MissingDisparitiesSayNothing) {
  OctomapBaseline octomap(test_params());
  octomap.integrate({cv::Mat1f(21, 21, 0.0F), cv::Mat1f(21, 21, 0.0F)}, small_camera(),
                    forward_pose());
  EXPECT_EQ(drawing_of(octomap.map(kOctomapGrid, 0.0)), Drawing(4, "??????????"));
}

TEST(OctomapBaseline, MergedVoxelsFillAllTheirCells) {
  OctomapBaselineParams params = test_params();
  const GridGeometry fine{
      .origin_m = {0, -0.5}, .cell_size_m = 0.5 * kOctomapCell_m, .width = 20, .height = 8};
  OctomapBaseline octomap(params);
  octomap.integrate(wall_at(1.75), small_camera(), forward_pose());
  const Drawing map = drawing_of(octomap.map(fine, 0.0));
  EXPECT_EQ(map[3].substr(12), "..##????");
  EXPECT_EQ(map[2], map[3]);
}

TEST(OctomapBaseline, GridWithoutCellsIsRefused) {
  EXPECT_THROW(OctomapBaseline(test_params()).map({.width = 0, .height = 1}, 0.0), Error);
}

}  // namespace
}  // namespace stereovox
