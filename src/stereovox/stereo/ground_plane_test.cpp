#include "stereovox/stereo/ground_plane.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "stereovox/core/angles.h"

namespace stereovox {
namespace {

const RectifiedCamera kCamera{{640, 480, 525.0, 520.0, 320.0, 240.0}, 0.12};

// Down, in a camera that is pitched down and rolled clockwise.
Eigen::Vector3d down_for(double pitch_deg, double roll_deg) {
  const double p = pitch_deg * kDegree_rad, r = roll_deg * kDegree_rad;
  return {std::cos(p) * std::sin(r), std::cos(p) * std::cos(r), std::sin(p)};
}

// A floor, a wall ahead, a wide box on the floor, noise, holes and gross mismatches.
DisparityImage room(const Eigen::Vector3d& down, double height_m) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise_px(0.0, 0.3);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  DisparityImage image{cv::Mat1f(480, 640, 0.0F), cv::Mat1f(480, 640, 0.0F)};
  for (int v = 0; v < 480; ++v)
    for (int u = 0; u < 640; ++u) {
      const Eigen::Vector3d ray((u - 320.0) / 525.0, (v - 240.0) / 520.0, 1.0);
      const double z_floor = down.dot(ray) > 0.0 ? height_m / down.dot(ray) : 1e9;
      const double z_box = u > 400 && v > 280 ? 1.4 : 1e9;
      const double z = std::min({z_floor, z_box, 6.0});
      const double d = uniform(random) < 0.05 ? 60.0 * uniform(random)
                                              : kCamera.disparity_px(z) + noise_px(random);
      if (uniform(random) > 0.2) image.disparity_px(v, u) = static_cast<float>(std::max(d, 0.0));
    }
  return image;
}

TEST(GroundPlane, IsFoundBeneathAPitchedAndRolledCamera) {
  for (const auto& [pitch_deg, roll_deg, height_m] :
       {std::tuple{0.0, 0.0, 0.6}, {4.0, -2.0, 0.62}, {20.0, 5.0, 1.2}, {-3.0, 1.0, 0.3}}) {
    const Eigen::Vector3d down = down_for(pitch_deg, roll_deg);
    const auto plane = estimate_ground_plane(room(down, height_m), kCamera, {});
    ASSERT_TRUE(plane) << pitch_deg;
    EXPECT_NEAR(plane->height_m, height_m, 0.01 + 0.01 * height_m);
    EXPECT_LT(std::acos(plane->down_camera.dot(down)) / kDegree_rad, 0.3);
    EXPECT_GT(plane->share, 0.3);
  }
}

TEST(GroundPlane, IsNotInventedBeforeAWallOrWithoutDisparities) {
  DisparityImage wall{cv::Mat1f(480, 640, 20.0F), cv::Mat1f(480, 640, 0.3F)};
  EXPECT_FALSE(estimate_ground_plane(wall, kCamera, {}));
  wall.disparity_px.setTo(0.0F);
  EXPECT_FALSE(estimate_ground_plane(wall, kCamera, {}));
}

}  // namespace
}  // namespace stereovox
