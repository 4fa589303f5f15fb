#include "stereovox/occupancy/floor_surface.h"

#include <gtest/gtest.h>

#include <cmath>

#include "stereovox/occupancy/integrate.h"
#include "stereovox/occupancy/scene_for_test.h"

namespace stereovox {
namespace {

constexpr double kFarthest_m = 8.0;
constexpr double kTan10 = 0.1763;  // of 10 degrees

// A camera 0.5 m above a landscape, which drives along x through it, a quarter of a metre a frame.
template <class Height>
FloorSurface drive_over(Height z_at, double length_m, double level_z_m = 0.0) {
  FloorSurface floor(level_z_m);
  for (double x = 0.0; x <= length_m; x += 0.25) {
    const SE3 pose = scene::level_pose(0.0, {x, 0, z_at(x, 0.0) + 0.5});
    floor.observe(surface_points(scene::landscape(pose, z_at), scene::camera(), pose, kFarthest_m),
                  pose.translation);
  }
  return floor;
}

// Rises by 10 degrees from x = 3 to x = 6.
double ramp_z(double x, double /*y*/) { return kTan10 * std::clamp(x - 3.0, 0.0, 3.0); }

double z_at(const FloorSurface& floor, double x, double y) {
  return FloorReader(floor).z_m({x, y});
}

TEST(FloorSurface, IsTheLevelUntilSomethingIsSeen) {
  EXPECT_TRUE(FloorSurface(0.3).is_level());
  EXPECT_EQ(z_at(FloorSurface(0.3), 5, -2), 0.3);
  EXPECT_EQ(FloorSurface(0.3).z_range_m({5, -2}, 4.0), std::pair(0.3, 0.3));
}

TEST(FloorSurface, StaysLevelWhereTheFloorIsNearlyLevel) {
  const auto wavy = [](double x, double y) { return 0.03 * std::sin(3.0 * x) * std::cos(2.0 * y); };
  const FloorSurface floor = drive_over(wavy, 4.0);
  EXPECT_GT(floor.squares().size(), 30U);
  EXPECT_TRUE(floor.is_level());
  EXPECT_EQ(z_at(floor, 3.1, 0.2), 0.0);
}

TEST(FloorSurface, FollowsARampAndThePlaneBehindIt) {
  const FloorSurface floor = drive_over(ramp_z, 7.0);
  EXPECT_FALSE(floor.is_level());
  for (const double x : {2.0, 4.0, 5.0, 5.8, 7.5, 8.5})
    EXPECT_NEAR(z_at(floor, x, 0.1), ramp_z(x, 0.1), 0.06) << x;
  const auto [low_m, high_m] = floor.z_range_m({4.5, 0}, 6.0);
  EXPECT_NEAR(low_m, 0.0, 0.05);
  EXPECT_NEAR(high_m, ramp_z(9.0, 0.0), 0.05);
  EXPECT_EQ(floor.z_range_m(), std::pair(low_m, high_m));
  EXPECT_EQ(floor.z_range_m({0.9, 0.0}, 0.6), std::pair(0.0, 0.0));
}

TEST(FloorSurface, FollowsADescent) {
  const auto down_z = [](double x, double y) { return -ramp_z(x, y); };
  const FloorSurface floor = drive_over(down_z, 7.0);
  for (const double x : {2.0, 4.5, 7.5}) EXPECT_NEAR(z_at(floor, x, 0.1), down_z(x, 0), 0.06) << x;
}

TEST(FloorSurface, FollowsALevelThatWasTilted) {
  const auto tilted_z = [](double x, double y) { return 0.05 * x - 0.03 * y; };
  const FloorSurface floor = drive_over(tilted_z, 10.0);
  for (const double x : {1.5, 6.0, 11.0})
    EXPECT_NEAR(z_at(floor, x, 0.3), tilted_z(x, 0.3), 0.04) << x;
}

TEST(FloorSurface, DoesNotClimbASteep) {
  const auto steep_z = [](double x, double /*y*/) { return 0.5 * std::clamp(x - 3.0, 0.0, 3.0); };
  const FloorSurface floor = drive_over(steep_z, 2.0);
  EXPECT_LT(z_at(floor, 4.5, 0.0), 0.2);
}

TEST(FloorSurface, DoesNotClimbAStepABoxOrAWall) {
  const auto things_z = [](double x, double y) {
    if (x > 5.0) return 3.0;                            // wall
    if (x > 3.0 && y > 0.5) return 0.15;                // platform
    return x > 3.0 && x < 4.0 && y < -0.5 ? 0.3 : 0.0;  // box
  };
  const FloorSurface floor = drive_over(things_z, 2.0);
  EXPECT_TRUE(floor.is_level());
}

TEST(FloorSurface, StaysLevelUntilSeveralSquaresDiffer) {
  FloorSurface floor;
  for (int i = 0; i < 4; ++i) {
    EXPECT_TRUE(floor.is_level()) << i;
    EXPECT_EQ(floor.z_range_m(), std::pair(0.0, 0.0));
    const std::vector<SurfacePoint> points(20, {{1.2 + 0.5 * i, 0.2, 0.08}, true});
    floor.observe(points, {0, 0, 1});
  }
  EXPECT_FALSE(floor.is_level());
  EXPECT_NEAR(z_at(floor, 1.7, 0.2), 0.08, 1e-6);
}

// The foot of a wall, or a heap: a few flat points among many.
TEST(FloorSurface, NeedsMostOfWhatIsSeenToBeFlat) {
  std::vector<SurfacePoint> points(20, {{1.2, 0.2, 0.08}, true});
  points.resize(45, {{1.2, 0.2, 0.3}, false});
  FloorSurface floor;
  floor.observe(points, {0, 0, 1});
  EXPECT_TRUE(floor.squares().empty());
  points.resize(40);
  points.resize(100, {{1.2, 0.2, 2.5}, false});  // the ceiling
  floor.observe(points, {0, 0, 1});
  EXPECT_EQ(floor.squares().size(), 1U);
}

TEST(SurfacePoints, AreFlatOnFloorsAndNotOnWallsOrWhereTheyMeet) {
  const auto room_z = [](double x, double /*y*/) { return x > 3.0 ? 2.0 : 0.0; };
  const SE3 pose = scene::level_pose(0.0, {0, 0, 0.5});
  int flat = 0, upright = 0;
  for (const auto& [p, is_flat] :
       surface_points(scene::landscape(pose, room_z), scene::camera(), pose, kFarthest_m)) {
    const bool is_on_floor = p.x() < 2.8 && p.z()<0.05, is_on_wall = p.x()> 2.9 && p.z() > 0.1;
    flat += is_on_floor && is_flat;
    upright += is_on_wall;
    EXPECT_FALSE(is_on_wall && is_flat) << p.transpose();
  }
  EXPECT_GT(flat, 200);
  EXPECT_GT(upright, 200);
}

TEST(FloorSurface, BeyondWhatWasSeenTheNearestHolds) {
  const FloorSurface floor = drive_over(ramp_z, 7.0);
  EXPECT_FALSE(floor.squares().contains({28, 0}));
  EXPECT_NEAR(z_at(floor, 14.2, 0.1), ramp_z(14.2, 0.1), 0.06);
  EXPECT_EQ(z_at(floor, 8.0, 50.0), 0.0);  // nothing is near
}

TEST(FloorSurface, ChangesSmoothly) {
  const FloorSurface floor = drive_over(ramp_z, 7.0);
  FloorReader reader(floor);
  for (double x = 1.0; x < 8.0; x += 0.01)
    EXPECT_LT(std::abs(reader.z_m({x + 0.01, 0.0}) - reader.z_m({x, 0.0})), 0.01) << x;
}

TEST(FloorSurface, MergesWhatOnlyTheOtherKnows) {
  const FloorSurface ramp = drive_over(ramp_z, 7.0);
  FloorSurface merged = drive_over([](double, double) { return 0.0; }, 0.0);
  const std::size_t own = merged.squares().size();
  merged.merge(ramp, {Eigen::Quaterniond::Identity(), {10.0, 0.0, 1.0}});
  EXPECT_EQ(merged.squares().size(), own + ramp.squares().size());
  EXPECT_NEAR(z_at(merged, 15.0, 0.1), 1.0 + ramp_z(5.0, 0.1), 0.06);
  merged.merge(ramp, {});
  EXPECT_NEAR(z_at(merged, 2.0, 0.1), 0.0, 0.01);
}

TEST(FloorSurface, BytesHoldAll) {
  const FloorSurface floor = drive_over(ramp_z, 7.0, 0.1);
  EXPECT_EQ(floor_from_bytes(to_bytes(floor), 0.1), floor);
}

TEST(FloorSurface, DamagedBytesAreRefused) {
  const std::string bytes = to_bytes(drive_over(ramp_z, 1.0));
  const auto read = [](const std::string& from) { return floor_from_bytes(from, 0.0); };
  EXPECT_THROW(read("floor 9\n"), std::runtime_error);
  EXPECT_THROW(read(bytes + "x"), std::runtime_error);
  EXPECT_THROW(read(bytes.substr(0, bytes.size() - 3)), std::out_of_range);
  std::string far = bytes;
  far[8 + 4 + 7] = -127;  // y of the first square
  EXPECT_THROW(read(far), std::runtime_error);
  std::string unordered = bytes;
  unordered[8 + 4 + 3] = 127;  // x of the first square
  EXPECT_THROW(read(unordered), std::runtime_error);
}

// The height limits of a frame go with the floor around it.
TEST(FloorSurface, MapsGrowAboveARamp) {
  for (const bool follows : {true, false}) {
    OccupancyParams params = scene::params(OccupancyPreset::tuned);
    params.follow_floor = follows;
    const auto steep_road_z = [](double x, double /*y*/) { return 0.15 * std::max(0.0, x - 1.0); };
    VoxelMap map(params.voxel_size_m);
    for (int i = 0; i < 45; ++i) {
      const double x = 0.5 * i;
      const SE3 pose = scene::level_pose(0.0, {x, 0, steep_road_z(x, 0) + 0.5});
      integrate(scene::landscape(pose, steep_road_z), scene::camera(), pose,
                i * scene::kSecond_ns / 5, params, 1, map);
    }
    EXPECT_EQ(map.bounds()->max.z() * params.voxel_size_m > 3.0, follows);
  }
}

}  // namespace
}  // namespace stereovox
