#include "stereovox/odometry/image_levels.h"

#include <gtest/gtest.h>

namespace stereovox {
namespace {

PairLevel level_of(int width, int height) {
  PairLevel level;
  level.pair.stamp_ns = 7;
  level.pair.left.pixels = cv::Mat1b(height, width, std::uint8_t{100});
  level.pair.right.pixels = cv::Mat1b(height, width, std::uint8_t{60});
  level.disparity = {cv::Mat1f(height, width, 8.0F), cv::Mat1f(height, width, 0.4F)};
  return level;
}

TEST(ImageLevels, PixelsAreTheMeanOfFourAndDisparitiesAreHalved) {
  PairLevel level = level_of(5, 4);  // the last column is left out
  level.pair.left.pixels(0, 0) = 120;
  const PairLevel half = halved(level);
  EXPECT_EQ(half.pair.left.pixels.size(), cv::Size(2, 2));
  EXPECT_EQ(half.pair.left.pixels(0, 0), 105);
  EXPECT_EQ(half.pair.right.pixels(1, 1), 60);
  EXPECT_EQ(half.disparity.disparity_px(0, 0), 4.0F);
  EXPECT_FLOAT_EQ(half.disparity.sigma_px(0, 0), 0.2F);
  EXPECT_EQ(half.pair.stamp_ns, 7);
  EXPECT_TRUE(half.pair.valid_left.empty());
}

TEST(ImageLevels, NoDisparityWhereMostOfTheFourHaveNoneOrTheyDiffer) {
  PairLevel level = level_of(6, 2);
  level.disparity.disparity_px(0, 0) = 0.0F;                                       // three are left
  level.disparity.disparity_px(0, 2) = level.disparity.disparity_px(1, 2) = 0.0F;  // two
  level.disparity.disparity_px(0, 4) = 11.0F;  // another surface
  const cv::Mat1f disparity_px = halved(level).disparity.disparity_px;
  EXPECT_EQ(disparity_px(0, 0), 4.0F);
  EXPECT_EQ(disparity_px(0, 1), 0.0F);
  EXPECT_EQ(disparity_px(0, 2), 0.0F);
}

TEST(ImageLevels, ValidWhereAllFourAre) {
  PairLevel level = level_of(4, 2);
  level.pair.valid_left = cv::Mat1b(2, 4, std::uint8_t{255});
  level.pair.valid_left(1, 1) = 0;
  const cv::Mat1b valid = halved(level).pair.valid_left;
  EXPECT_EQ(valid(0, 0), 0);
  EXPECT_EQ(valid(0, 1), 255);
}

TEST(ImageLevels, TheSmallerCameraSeesAPointInTheMiddleOfItsFourPixels) {
  const RectifiedCamera camera{{640, 480, 525, 520, 319.5, 239.5}, 0.12};
  const Eigen::Vector3d p(0.4, -0.3, 2.5);
  const Eigen::Vector2d full = project(camera.pinhole, p),
                        half = project(halved(camera).pinhole, p);
  EXPECT_NEAR(half.x(), (full.x() - 0.5) / 2, 1e-12);
  EXPECT_NEAR(half.y(), (full.y() - 0.5) / 2, 1e-12);
  EXPECT_EQ(halved(camera).pinhole.width, 320);
}

TEST(ImageLevels, TinyImagesBecomeEmpty) {
  const PairLevel half = halved(level_of(1, 1));
  EXPECT_TRUE(half.pair.left.pixels.empty());
  EXPECT_TRUE(half.disparity.disparity_px.empty());
}

}  // namespace
}  // namespace stereovox
