#include "stereovox/navmap/wall_faces.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "stereovox/core/error.h"
#include "stereovox/occupancy/byte_buffer.h"
#include "stereovox/occupancy/scene_for_test.h"

namespace stereovox {
namespace {

constexpr double kFaceCell_m = 0.25;
constexpr int kFrames = 20;
constexpr NavmapParams kParams{.min_reach = 0.1};
const Eigen::Vector2i kTowardsCamera(-1, 0), kAway(1, 0);

void observe(const DisparityImage& image, const SE3& T_world_camera, WallFaces& faces) {
  OccupancyParams occupancy;
  occupancy.voxel_size_m = kFaceCell_m;
  VoxelMap map(kFaceCell_m);
  const RectifiedCamera camera = scene::camera();
  faces.observe(view_frame(image, camera, T_world_camera, 0, occupancy, map), map.floor, kParams);
}

// What a camera at x = 0 that looks along `yaw_rad` sees for some time.
WallFaces faces_of(const DisparityImage& image, double yaw_rad = 0.0) {
  WallFaces faces;
  for (int i = 0; i < kFrames; ++i) observe(image, scene::level_pose(yaw_rad), faces);
  return faces;
}

// A wall across the view of a camera at `camera_x_m`, `depth_m` away; each pixel has an error, in
// each frame another.
WallFaces faces_of_wall(double camera_x_m, double depth_m, bool looks_back = false) {
  std::mt19937 random(3);
  std::normal_distribution<float> noise_px(0.0F, 0.3F);
  const double yaw_rad = looks_back ? std::numbers::pi : 0.0;
  WallFaces faces;
  for (int i = 0; i < kFrames; ++i) {
    DisparityImage image = scene::wall_at(depth_m);
    for (float& disparity : image.disparity_px) disparity += noise_px(random);
    observe(image, scene::level_pose(yaw_rad, {camera_x_m, 0, 1}), faces);
  }
  return faces;
}

TEST(WallFaces, TellOnWhichSideOfABorderAWallStands) {
  // The border between cells 7 and 8 along x is at 2 m; the error of a point is 3 to 4 cm.
  for (const double wall_x_m : {1.96, 1.985, 2.015, 2.04}) {
    const auto reach = faces_of_wall(0.0, wall_x_m).reach_m({7, 0}, kTowardsCamera);
    ASSERT_TRUE(reach.has_value());
    EXPECT_NEAR(*reach, 2.0 - wall_x_m, 0.01) << wall_x_m;
  }
}

TEST(WallFaces, ASurfaceIsKnownFromTheSideItIsSeenFromOnly) {
  const WallFaces faces = faces_of_wall(0.0, 1.98);
  EXPECT_TRUE(faces.reach_m({7, 0}, kTowardsCamera).has_value());
  EXPECT_FALSE(faces.reach_m({8, 0}, kAway).has_value());
  EXPECT_FALSE(faces.reach_m({5, 0}, kTowardsCamera).has_value());
}

TEST(WallFaces, FromTheOtherSideTheSignIsTheOther) {
  // From x = 4 m the wall at 2.03 m stands in cell 8, 3 cm before the border with cell 7.
  const auto reach = faces_of_wall(4.0, 1.97, true).reach_m({8, 0}, kAway);
  ASSERT_TRUE(reach.has_value());
  EXPECT_NEAR(*reach, 0.03, 0.01);
}

TEST(WallFaces, AShelfCountsHoweverMuchWallIsBelowIt) {
  DisparityImage image = scene::wall_at(2.04);
  const DisparityImage shelf = scene::wall_at(1.94);
  const cv::Rect above(0, 0, image.width(), 3 * image.height() / 8);  // 1.2 m
  shelf.disparity_px(above).copyTo(image.disparity_px(above));
  const auto reach = faces_of(image).reach_m({7, 0}, kTowardsCamera);
  ASSERT_TRUE(reach.has_value());
  EXPECT_NEAR(*reach, 0.06, 0.01);
}

TEST(WallFaces, WhatStandsInTheNearerHalfOfACellFillsIt) {
  EXPECT_EQ(faces_of(scene::wall_at(1.8)).reach_m({7, 0}, kTowardsCamera), WallFaces::kWholeCell);
}

TEST(WallFaces, TheSideOfAWallSaysNothingOfWhereItEnds) {
  // The wall runs along x, on the left, at y = 2 m, across the borders of cells 0 and 1 along x.
  const WallFaces faces = faces_of(scene::wall_at(1.98), std::numbers::pi / 2);
  EXPECT_TRUE(faces.reach_m({0, 7}, {0, -1}).has_value());
  for (const int x : {-2, -1, 0, 1})
    for (const Eigen::Vector2i& step : {kTowardsCamera, kAway})
      EXPECT_FALSE(faces.reach_m({x, 7}, step).has_value()) << x;
}

TEST(WallFaces, PointsTooFarForTheVoxelAreLeftOut) {
  // At 6 m the error of a point is about 34 cm.
  EXPECT_TRUE(faces_of_wall(0.0, 6.0).is_empty());
}

TEST(WallFaces, NewPointsMoveAFaceThatIsKnownWell) {
  WallFace face;
  for (int i = 0; i < 300'000; ++i) face.add(0.05, 1e4);
  EXPECT_NEAR(face.mean_m, 0.05F, 1e-4F);
  for (int i = 0; i < 300'000; ++i) face.add(-0.05, 1e4);
  EXPECT_LT(face.mean_m, -0.03F);
}

SE3 moved_by(double x_m, double y_m, double z_m) {
  return {Eigen::Quaterniond::Identity(), {x_m, y_m, z_m}};
}

TEST(WallFaces, OfAnotherMapMoveByWholeCellsAndSlices) {
  const WallFaces other = faces_of_wall(0.0, 1.98);
  WallFaces merged;
  EXPECT_TRUE(merged.merge(other, moved_by(10 * kFaceCell_m, -3 * kFaceCell_m, 0.5), kFaceCell_m));
  EXPECT_EQ(merged.reach_m({17, -3}, kTowardsCamera), other.reach_m({7, 0}, kTowardsCamera));
  EXPECT_FALSE(merged.reach_m({7, 0}, kTowardsCamera).has_value());
  for (const SE3& T : {moved_by(0.1, 0, 0), moved_by(0, 0, 0.1),
                       SE3{Eigen::Quaterniond(0, 0, 0, 1), Eigen::Vector3d::Zero()}}) {
    EXPECT_FALSE(merged.merge(other, T, kFaceCell_m));
    EXPECT_TRUE(merged.merge(WallFaces{}, T, kFaceCell_m)) << "nothing is lost";
  }
}

TEST(WallFaces, OfTwoMapsAreMeansWeightedByWhatIsKnown) {
  WallFaces merged = faces_of_wall(0.0, 1.96);
  EXPECT_TRUE(merged.merge(faces_of_wall(0.0, 1.98), SE3{}, kFaceCell_m));
  const auto reach = merged.reach_m({7, 0}, kTowardsCamera);
  ASSERT_TRUE(reach.has_value());
  EXPECT_NEAR(*reach, 0.03, 0.01);
}

TEST(WallFaces, SurviveTheirBytes) {
  const WallFaces before = faces_of_wall(0.0, 1.98);
  EXPECT_FALSE(before.is_empty());
  EXPECT_EQ(wall_faces_from_bytes(to_bytes(before), "map.svx"), before);
  EXPECT_EQ(wall_faces_from_bytes(to_bytes(WallFaces{}), "map.svx"), WallFaces{});
}

TEST(WallFaces, OfTheFirstFormAreRead) {
  // One tile, one face: of the border below cell (8, 0), seen from below.
  std::string bytes = "wall faces 1\n";
  for (const std::int32_t number : {1, 1, 0}) append_number(bytes, number);
  bytes += '\1' + std::string(31, '\0');
  for (const float number : {0.02F, 1e6F}) append_number(bytes, number);
  const WallFaces faces = wall_faces_from_bytes(bytes, "map.svx");
  EXPECT_FLOAT_EQ(static_cast<float>(faces.reach_m({7, 0}, kTowardsCamera).value()), -0.02F);
}

TEST(WallFaces, DamagedBytesAreErrors) {
  const std::string good = to_bytes(faces_of_wall(0.0, 1.98));
  for (std::size_t length = 0; length < good.size(); length += 7)
    EXPECT_THROW(wall_faces_from_bytes(good.substr(0, length), "map.svx"), Error) << length;
  EXPECT_THROW(wall_faces_from_bytes(good + "x", "map.svx"), Error);
  std::string without_faces = good;
  constexpr std::size_t kSlices = 13, kTiles = kSlices + 2 * 4;
  constexpr std::size_t kFirstMask = kTiles + 4 + 2 * 4, kMaskBytes = 32;
  without_faces.resize(kFirstMask + kMaskBytes);
  for (const std::size_t count : {kSlices, kTiles})
    without_faces.replace(count, 4, std::string("\1\0\0\0", 4));
  without_faces.replace(kFirstMask, kMaskBytes, std::string(kMaskBytes, '\0'));
  EXPECT_THROW(wall_faces_from_bytes(without_faces, "map.svx"), Error);
  std::string not_a_number = good;
  not_a_number.replace(good.size() - 4, 4, "\xff\xff\xff\x7f");
  EXPECT_THROW(wall_faces_from_bytes(not_a_number, "map.svx"), Error);
}

}  // namespace
}  // namespace stereovox
