#include "stereovox/navmap/draw_voxels.h"

#include <gtest/gtest.h>

#include "stereovox/navmap/drawn_map_for_test.h"

namespace stereovox {
namespace {

int painted(const cv::Mat3b& picture) {
  cv::Mat1b white;
  cv::inRange(picture, cv::Scalar(255, 255, 255), cv::Scalar(255, 255, 255), white);
  return static_cast<int>(picture.total()) - cv::countNonZero(white);
}

TEST(DrawVoxels, AnEmptyMapIsAWhitePicture) {
  const VoxelMap map(0.1);
  EXPECT_EQ(painted(draw_voxels(map)), 0);
}

TEST(DrawVoxels, OnlyOccupiedVoxelsThatWereSeenOftenEnoughAreDrawn) {
  VoxelMap map(0.1);
  set_voxel(map, {0, 0, 3}, kFreeState);
  set_voxel(map, {4, 0, 3}, kOccupiedState, 1);
  EXPECT_EQ(painted(draw_voxels(map)), 0);
  set_voxel(map, {8, 0, 3}, kOccupiedState);
  EXPECT_GT(painted(draw_voxels(map)), 0);
}

TEST(DrawVoxels, SeenFromAboveTheHigherVoxelCoversTheLower) {
  VoxelView from_above;
  from_above.elevation_deg = 90.0;
  VoxelMap low(0.1), both(0.1);
  set_voxel(low, {0, 0, 0}, kOccupiedState);
  set_voxel(both, {0, 0, 0}, kOccupiedState);
  set_voxel(both, {0, 0, 15}, kOccupiedState);
  const cv::Mat3b blue = draw_voxels(low, from_above), red = draw_voxels(both, from_above);
  const cv::Vec3b low_colour = blue(blue.rows / 2, blue.cols / 2);
  const cv::Vec3b high_colour = red(red.rows / 2, red.cols / 2);
  EXPECT_GT(low_colour[0], low_colour[2]);
  EXPECT_GT(high_colour[2], high_colour[0]);
}

}  // namespace
}  // namespace stereovox
