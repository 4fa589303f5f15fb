#include "stereovox/pipeline/world_frame.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stereovox/core/angles.h"

namespace stereovox {
namespace {

using Eigen::Vector3d;

SE3 turned_about_y(double angle_rad, const Vector3d& translation) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, Vector3d::UnitY())), translation};
}

GroundPlane floor_below(double height_m, double pitch_deg) {
  const double p = pitch_deg * kDegree_rad;
  return {{0.0, std::cos(p), std::sin(p)}, height_m, 0.5};
}

// A camera in a z-up world, looking along +y and pitched down.
SE3 in_z_up_world(const Vector3d& position, double pitch_deg) {
  Eigen::Matrix3d R_world_level;  // camera x, y, z in the world
  R_world_level << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  const Eigen::Quaterniond pitch(Eigen::AngleAxisd(-pitch_deg * kDegree_rad, Vector3d::UnitX()));
  return {Eigen::Quaterniond(R_world_level) * pitch, position};
}

TEST(WorldFrame, HasItsOriginOnTheFloorBelowTheFirstCameraAndLooksAlongX) {
  const std::vector<GroundView> views = {{SE3{}, floor_below(0.6, 5.0)},
                                         {SE3{}, floor_below(0.6, 5.0)}};
  const WorldFrame world = world_of_odometry(views, {});
  EXPECT_LT((world.T_world_segment * Vector3d::Zero() - Vector3d(0, 0, 0.6)).norm(), 1e-9);
  const Vector3d ahead = world.T_world_segment * Vector3d(0, 0, 1);
  EXPECT_NEAR(ahead.x(), std::cos(5.0 * kDegree_rad), 1e-9);
  EXPECT_NEAR(ahead.y(), 0.0, 1e-9);
  EXPECT_NEAR(ahead.z(), 0.6 - std::sin(5.0 * kDegree_rad), 1e-9);
  EXPECT_EQ(world.source,
            "camera 0.600 m above the floor, pitched down 5.0 deg (from the ground plane in the "
            "first frames)");
}

TEST(WorldFrame, BeginsAtTheStartPoseInTheFirstSegmentOnly) {
  const std::vector<GroundView> views = {{SE3{}, floor_below(0.6, 5.0)}};
  WorldFrameParams params;
  params.start_x_m = 3;
  params.start_y_m = -2;
  params.start_yaw_deg = 90;
  const SE3 first = world_of_odometry(views, params).T_world_segment;
  EXPECT_LT((first * Vector3d::Zero() - Vector3d(3, -2, 0.6)).norm(), 1e-9);
  const Vector3d ahead = first * Vector3d(0, 0, 1);
  EXPECT_NEAR(ahead.x(), 3.0, 1e-9);
  EXPECT_NEAR(ahead.y(), -2 + std::cos(5.0 * kDegree_rad), 1e-9);
  const SE3 later = world_of_odometry(views, params, false).T_world_segment;
  EXPECT_LT((later * Vector3d::Zero() - Vector3d(0, 0, 0.6)).norm(), 1e-9);
}

TEST(WorldFrame, TakesTheFloorThatMostViewsAgreeOn) {
  std::vector<GroundView> views;
  for (int i = 0; i < 4; ++i)
    views.push_back({turned_about_y(0.1 * i, Vector3d(0, 0, 0.1 * i)), floor_below(0.6, 0.0)});
  views.push_back({SE3{}, floor_below(1.4, 10.0)});  // a table top, say
  EXPECT_NEAR((world_of_odometry(views, {}).T_world_segment * Vector3d::Zero()).z(), 0.6, 1e-9);
}

TEST(WorldFrame, SaysWhenTheFloorIsAssumedOrGiven) {
  const std::vector<GroundView> views = {{SE3{}, std::nullopt}, {SE3{}, std::nullopt}};
  WorldFrameParams params;
  EXPECT_THAT(world_of_odometry(views, params).source,
              testing::HasSubstr("assumed: no ground plane was found; give both --camera-height"));
  EXPECT_TRUE(world_of_odometry(views, params).is_assumed);
  params.level = LevelSource::given;
  params.camera_height_m = 1.65;
  params.camera_pitch_deg = -2.0;
  EXPECT_EQ(world_of_odometry(views, params).source,
            "camera 1.650 m above the floor, pitched down -2.0 deg (as given)");
  EXPECT_FALSE(world_of_odometry(views, params).is_assumed);
}

TEST(WorldFrame, KeepsAGivenWorldWithZUpAndFindsItsFloor) {
  const std::vector<GroundView> views = {
      {in_z_up_world({3, 1, 1.62}, 4.0), floor_below(0.62, 4.0)}};
  const WorldFrame world = world_of_given_poses(views, {});
  EXPECT_LT(log(world.T_world_segment).norm(), 1e-12);
  EXPECT_NEAR(world.floor_z_m, 1.0, 1e-9);
}

TEST(WorldFrame, TakesZeroForTheFloorOfAGivenWorldThatShowsNone) {
  const std::vector<GroundView> views = {{in_z_up_world({3, 1, 1.62}, 4.0), std::nullopt}};
  EXPECT_EQ(world_of_given_poses(views, {}).floor_z_m, 0.0);
  EXPECT_TRUE(world_of_given_poses(views, {}).is_assumed);
}

TEST(WorldFrame, LevelsAGivenWorldWhoseZIsNotUp) {
  const std::vector<GroundView> views = {{SE3{}, floor_below(1.6, 0.0)}};
  const WorldFrame world = world_of_given_poses(views, {});
  EXPECT_LT((world.T_world_segment * Vector3d(0, 1.6, 10) - Vector3d(10, 0, 0)).norm(), 1e-9);
  EXPECT_THAT(world.source, testing::StartsWith("z of the given poses is not up"));
}

}  // namespace
}  // namespace stereovox
