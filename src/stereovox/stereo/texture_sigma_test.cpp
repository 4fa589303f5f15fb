#include "stereovox/stereo/texture_sigma.h"

#include <gtest/gtest.h>

namespace stereovox {
namespace {

// Brightness rises by `step` a pixel along each row, back and forth.
GrayImage ramps(int step) {
  GrayImage image{cv::Mat1b(40, 60)};
  for (int v = 0; v < 40; ++v)
    for (int u = 0; u < 60; ++u) image.pixels(v, u) = static_cast<uchar>(100 + step * (u % 20));
  return image;
}

TEST(TextureSigma, FollowsTheGradientAlongTheRow) {
  EXPECT_NEAR(texture_sigma_px(ramps(2), 0.2, 0.4)(20, 10), std::hypot(0.2, 0.4 / 2), 1e-5);
  EXPECT_NEAR(texture_sigma_px(ramps(1), 0.2, 0.4)(20, 10), std::hypot(0.2, 0.4), 1e-5);
}

TEST(TextureSigma, IsBoundedWhereThereIsNoTexture) {
  EXPECT_NEAR(texture_sigma_px(ramps(0), 0.2, 0.4)(20, 10), std::hypot(0.2, 4.0), 1e-4);
}

TEST(TextureSigma, GradientsAcrossTheRowDoNotHelp) {
  const GrayImage image{ramps(3).pixels.t()};
  EXPECT_GT(texture_sigma_px(image, 0.2, 0.4)(10, 20), 3.0F);
}

}  // namespace
}  // namespace stereovox
