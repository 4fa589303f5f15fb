#include "stereovox/odometry/patch_alignment.h"

#include <gtest/gtest.h>

#include <cmath>

namespace stereovox {
namespace {

// A smooth texture that repeats only far away, seen from a place moved by (du, dv).
cv::Mat1b waves(double du, double dv, double gain, double offset) {
  cv::Mat1b image(60, 80);
  for (int v = 0; v < image.rows; ++v)
    for (int u = 0; u < image.cols; ++u) {
      const double x = u + du, y = v + dv;
      const double value = 100.0 + 30.0 * std::sin(0.55 * x + 0.2 * y) + 25.0 * std::cos(0.6 * y) +
                           20.0 * std::sin(0.31 * x - 0.37 * y);
      image(v, u) = static_cast<std::uint8_t>(std::lround(gain * value + offset));
    }
  return image;
}

const Eigen::Vector2d kCenter(40.0, 30.0);

PatchTemplate patch_of_the_waves() {
  return cut_patch(waves(0, 0, 1, 0), kCenter, Eigen::Matrix2d::Identity()).value();
}

TEST(PatchAlignment, FindsAFractionOfAPixelInSpiteOfBrightnessAndContrast) {
  const cv::Mat1b moved = waves(1.3, -0.7, 0.8, 30.0);
  const auto found =
      align_patch(patch_of_the_waves(), moved, kCenter, AlignmentFreedom::both_axes, 4.0);
  ASSERT_TRUE(found);
  EXPECT_LT((found->pixel - Eigen::Vector2d(38.7, 30.7)).norm(), 0.03);
  EXPECT_GT(found->score, 0.999);
}

TEST(PatchAlignment, AlongARowTheRowStays) {
  const cv::Mat1b moved = waves(1.3, 0.0, 1.0, 0.0);
  const auto found =
      align_patch(patch_of_the_waves(), moved, kCenter, AlignmentFreedom::along_row, 4.0);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->pixel.x(), 38.7, 0.02);
  EXPECT_EQ(found->pixel.y(), 30.0);
}

TEST(PatchAlignment, DoesNotGoFartherThanAllowedOrOutOfTheImage) {
  const PatchTemplate patch = patch_of_the_waves();
  const cv::Mat1b moved = waves(2.0, 0.0, 1.0, 0.0);
  EXPECT_FALSE(align_patch(patch, moved, kCenter, AlignmentFreedom::both_axes, 1.0));
  EXPECT_FALSE(align_patch(patch, moved, {3.0, 30.0}, AlignmentFreedom::both_axes, 4.0));
  EXPECT_FALSE(align_patch(patch, moved, {NAN, 30.0}, AlignmentFreedom::both_axes, 4.0));
}

TEST(PatchAlignment, PatchesWithoutContrastOrOutsideAreNotCut) {
  const Eigen::Matrix2d identity = Eigen::Matrix2d::Identity();
  EXPECT_FALSE(cut_patch(cv::Mat1b(60, 80, std::uint8_t{90}), kCenter, identity));
  EXPECT_FALSE(cut_patch(waves(0, 0, 1, 0), {4.0, 30.0}, identity));
}

TEST(PatchAlignment, AnEdgeHoldsThePatchInOneDirectionOnly) {
  cv::Mat1b edge(60, 80, std::uint8_t{50});
  edge.colRange(40, 80) = 150;
  const PatchTemplate patch = cut_patch(edge, kCenter, Eigen::Matrix2d::Identity()).value();
  EXPECT_FALSE(align_patch(patch, edge, kCenter, AlignmentFreedom::both_axes, 4.0));
  EXPECT_TRUE(align_patch(patch, edge, kCenter, AlignmentFreedom::along_row, 4.0));
}

TEST(PatchAlignment, APatchSeenTwiceAsLargeIsFoundWithTheRightMap) {
  cv::Mat1b large(120, 160);
  const cv::Mat1b small = waves(0, 0, 1, 0);
  for (int v = 0; v < large.rows - 2; ++v)
    for (int u = 0; u < large.cols - 2; ++u)
      large(v, u) = static_cast<std::uint8_t>((small(v / 2, u / 2) + small((v + 1) / 2, u / 2) +
                                               small(v / 2, (u + 1) / 2) +
                                               small((v + 1) / 2, (u + 1) / 2) + 2) /
                                              4);
  const Eigen::Matrix2d half = 0.5 * Eigen::Matrix2d::Identity();
  const PatchTemplate patch = cut_patch(small, kCenter, half).value();
  const auto found = align_patch(patch, large, {81.2, 59.1}, AlignmentFreedom::both_axes, 4.0);
  ASSERT_TRUE(found);
  EXPECT_LT((found->pixel - 2.0 * kCenter).norm(), 0.05);
}

}  // namespace
}  // namespace stereovox
