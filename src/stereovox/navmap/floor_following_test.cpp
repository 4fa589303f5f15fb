// Drives over a ramp: what rises with the floor is no obstacle, what stands on it is one.
#include <gtest/gtest.h>

#include "stereovox/navmap/project_to_2d.h"
#include "stereovox/occupancy/integrate.h"
#include "stereovox/occupancy/scene_for_test.h"

namespace stereovox {
namespace {

constexpr double kVoxel_m = 0.1;
const Eigen::Vector2d kFoot(2.5, 0.0), kMiddle(4.5, 0.0), kTop(7.5, 0.0);
constexpr double kBox_x_m = 8.3, kWall_y_m = 1.54;

// A corridor whose floor rises by 10 degrees from x = 3 to x = 6, and a box upstairs.
double floor_z(double x) { return 0.1763 * std::clamp(x - 3.0, 0.0, 3.0); }
double corridor_z(double x, double y) {
  if (std::abs(y) > kWall_y_m) return 3.0;
  const bool is_box = x > kBox_x_m && x < kBox_x_m + 0.5 && std::abs(y) < 0.4;
  return floor_z(x) + (is_box ? 0.4 : 0.0);
}

struct Mapped {
  VoxelMap map;
  SightLines sight_lines;
  WallFaces faces;
  NavmapParams params;

  CellLabel label_at(const Eigen::Vector2d& place) const {
    const OccupancyGrid2D grid = project_to_2d(map, sight_lines, params, faces);
    const Eigen::Vector2d cell = (place - grid.geometry.origin_m) / grid.geometry.cell_size_m;
    return grid.label_at(cell.array().floor().cast<int>());
  }
};

Mapped drive_through_corridor(bool follows_floor) {
  OccupancyParams occupancy = scene::params(OccupancyPreset::tuned);
  occupancy.voxel_size_m = kVoxel_m;
  occupancy.follow_floor = follows_floor;
  Mapped out{VoxelMap(kVoxel_m), {}, {}, {}};
  for (int i = 0; i < 36; ++i) {
    const double x = 0.2 * i;
    const SE3 pose = scene::level_pose(0.0, {x, 0, floor_z(x) + 0.5});
    const std::int64_t stamp_ns = i * scene::kSecond_ns / 5;
    const DisparityImage image = scene::landscape(pose, corridor_z);
    const FrameUpdate update =
        integrate(image, scene::camera(), pose, stamp_ns, occupancy, 1, out.map);
    out.sight_lines.observe(out.map, {x, 0.0}, update.hits, out.params);
    out.faces.observe(view_frame(image, scene::camera(), pose, stamp_ns, occupancy, out.map),
                      out.map.floor, out.params);
  }
  return out;
}

TEST(FloorFollowing, ARampIsFreeAndWhatStandsOnItIsNot) {
  const Mapped mapped = drive_through_corridor(true);
  for (const Eigen::Vector2d& place : {kFoot, kMiddle, kTop})
    EXPECT_EQ(mapped.label_at(place), CellLabel::free) << place.transpose();
  EXPECT_EQ(mapped.label_at({kBox_x_m + 0.05, 0.0}), CellLabel::occupied);
  for (const double x : {3.5, 4.5, 6.5})
    EXPECT_EQ(mapped.label_at({x, kWall_y_m + 0.03}), CellLabel::occupied) << x;
}

TEST(FloorFollowing, AboveALevelFloorARampIsAnObstacle) {
  const Mapped mapped = drive_through_corridor(false);
  EXPECT_EQ(mapped.label_at(kFoot), CellLabel::free);
  EXPECT_NE(mapped.label_at(kMiddle), CellLabel::free);
  EXPECT_NE(mapped.label_at(kTop), CellLabel::free);
}

// A map that was read back knows its floor.
TEST(FloorFollowing, AnotherBandIsAboveTheSameFloor) {
  Mapped mapped = drive_through_corridor(true);
  mapped.params.max_height_m = 0.3;
  for (const Eigen::Vector2d& place : {kFoot, kMiddle, kTop})
    EXPECT_EQ(mapped.label_at(place), CellLabel::free) << place.transpose();
  mapped.params.min_height_m = -0.1;
  EXPECT_EQ(mapped.label_at(kMiddle), CellLabel::occupied);
}

}  // namespace
}  // namespace stereovox
