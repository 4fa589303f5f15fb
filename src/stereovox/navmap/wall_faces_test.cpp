#include "stereovox/navmap/wall_faces.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "stereovox/core/error.h"
#include "stereovox/occupancy/scene_for_test.h"

namespace stereovox {
namespace {

constexpr double kFaceCell_m = 0.25;
constexpr NavmapParams kParams{.sure_state = 0.75};
const Eigen::Vector2i kTowardsCamera(-1, 0), kAway(1, 0);

// A wall across the view of a camera at `camera_x_m`, `depth_m` away; each pixel has an error.
WallFaces faces_of_wall(double camera_x_m, double depth_m, bool looks_back = false) {
  OccupancyParams occupancy;
  occupancy.voxel_size_m = kFaceCell_m;
  VoxelMap map(kFaceCell_m);
  std::mt19937 random(3);
  std::normal_distribution<float> noise_px(0.0F, 0.3F);
  DisparityImage image = scene::wall_at(depth_m);
  for (float& disparity : image.disparity_px) disparity += noise_px(random);
  const RectifiedCamera camera = scene::camera();
  const SE3 pose = scene::level_pose(looks_back ? std::numbers::pi : 0.0, {camera_x_m, 0, 1});
  WallFaces faces;
  for (int frame = 0; frame < 5; ++frame)
    faces.observe(view_frame(image, camera, pose, frame * scene::kSecond_ns, occupancy, map), 0.0,
                  kParams);
  return faces;
}

TEST(WallFaces, TellOnWhichSideOfABorderAWallStands) {
  // The border between cells 7 and 8 along x is at 2 m; the error of a point is 3 to 4 cm.
  for (const double wall_x_m : {1.96, 1.985, 2.015, 2.04}) {
    const auto reach = faces_of_wall(0.0, wall_x_m).reach_m({7, 0}, kTowardsCamera);
    ASSERT_TRUE(reach.has_value());
    // Points that err towards the camera weigh more.
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

TEST(WallFaces, SurviveTheirBytes) {
  const WallFaces before = faces_of_wall(0.0, 1.98);
  EXPECT_FALSE(before.is_empty());
  EXPECT_EQ(wall_faces_from_bytes(to_bytes(before), "map.svx"), before);
  EXPECT_EQ(wall_faces_from_bytes(to_bytes(WallFaces{}), "map.svx"), WallFaces{});
}

TEST(WallFaces, DamagedBytesAreErrors) {
  const std::string good = to_bytes(faces_of_wall(0.0, 1.98));
  for (std::size_t length = 0; length < good.size(); length += 7)
    EXPECT_THROW(wall_faces_from_bytes(good.substr(0, length), "map.svx"), Error) << length;
  EXPECT_THROW(wall_faces_from_bytes(good + "x", "map.svx"), Error);
  std::string without_faces = good;
  constexpr std::size_t kFirstMask = 13 + 4 + 2 * 4, kMaskBytes = 32;
  without_faces.resize(kFirstMask + kMaskBytes);
  without_faces.replace(13, 4, std::string("\1\0\0\0", 4));
  without_faces.replace(kFirstMask, kMaskBytes, std::string(kMaskBytes, '\0'));
  EXPECT_THROW(wall_faces_from_bytes(without_faces, "map.svx"), Error);
  std::string not_a_number = good;
  not_a_number.replace(good.size() - 4, 4, "\xff\xff\xff\x7f");
  EXPECT_THROW(wall_faces_from_bytes(not_a_number, "map.svx"), Error);
}

}  // namespace
}  // namespace stereovox
