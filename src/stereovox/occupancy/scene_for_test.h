// Small synthetic views for the tests of the occupancy stage.
#pragma once

#include <numbers>
#include <random>
#include <vector>

#include "stereovox/occupancy/frame_view.h"

namespace stereovox::scene {

inline constexpr std::int64_t kSecond_ns = 1'000'000'000;

// 64 x 48 pixels, 62 degrees wide.
inline RectifiedCamera camera() {
  return {
      .pinhole =
          {.width = 64, .height = 48, .fx_px = 52.5, .fy_px = 52.5, .cx_px = 31.5, .cy_px = 23.5},
      .baseline_m = 0.5};
}

// 1 m above the origin, looking along +x of the world, then turned to the left.
inline SE3 level_pose(double yaw_rad = 0.0, const Eigen::Vector3d& position = {0, 0, 1}) {
  Eigen::Matrix3d R_world_camera;
  R_world_camera << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return {Eigen::Quaterniond(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ())) *
              Eigen::Quaterniond(R_world_camera),
          position};
}

inline DisparityImage empty_image() {
  return {.disparity_px = cv::Mat1f(48, 64, 0.0F), .sigma_px = cv::Mat1f(48, 64, 0.25F)};
}

// A plane across the optical axis that fills the image.
inline DisparityImage wall_at(double depth_m) {
  DisparityImage image = empty_image();
  image.disparity_px.setTo(camera().disparity_px(depth_m));
  return image;
}

// A landscape, whose height is a function of x and y, up to 8 m away.
template <class Height>
DisparityImage landscape(const SE3& T_world_camera, Height z_at) {
  constexpr double kStep_m = 0.02, kFarthest_m = 8.0;
  const PinholeCamera c = camera().pinhole;
  DisparityImage image = empty_image();
  for (int v = 0; v < c.height; ++v)
    for (int u = 0; u < c.width; ++u) {
      const Eigen::Vector3d ray((u - c.cx_px) / c.fx_px, (v - c.cy_px) / c.fy_px, 1.0);
      double depth_m = kStep_m;
      const auto is_above = [&] {
        const Eigen::Vector3d p = T_world_camera * (depth_m * ray);
        return p.z() > z_at(p.x(), p.y());
      };
      while (depth_m < kFarthest_m && is_above()) depth_m += kStep_m;
      if (depth_m < kFarthest_m)
        image.disparity_px(v, u) = camera().disparity_px(depth_m - 0.5 * kStep_m);
    }
  return image;
}

// Blobs at random depths, with noise, holes, far points and nonsense.
inline DisparityImage random_image(std::mt19937& random) {
  std::uniform_real_distribution<float> depth_m(0.2F, 6.0F), noise_px(-0.4F, 0.4F), share(0, 1);
  std::uniform_int_distribution<int> u(0, 63), v(0, 47), side(1, 25);
  DisparityImage image = wall_at(depth_m(random));
  for (int blob = 0; blob < 12; ++blob) {
    const cv::Rect box =
        cv::Rect(u(random), v(random), side(random), side(random)) & cv::Rect(0, 0, 64, 48);
    image.disparity_px(box).setTo(blob % 4 == 0 ? 0.0
                                                : camera().disparity_px(double(depth_m(random))));
  }
  for (float& disparity : image.disparity_px)
    if (disparity > 0.0F) disparity += noise_px(random);  // some become negative
  for (float& sigma : image.sigma_px) sigma = 0.05F + share(random);
  image.disparity_px(3, 3) = std::numeric_limits<float>::quiet_NaN();
  image.disparity_px(5, 3) = std::numeric_limits<float>::infinity();
  image.disparity_px(7, 3) = 1e-40F;
  image.sigma_px(9, 3) = std::numeric_limits<float>::quiet_NaN();
  return image;
}

struct Frame {
  DisparityImage disparity;
  SE3 T_world_camera;
  std::int64_t stamp_ns = 0;
};

// A drive that turns and comes back to what it saw, with a gap in time.
inline std::vector<Frame> random_drive(unsigned seed, int frames) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> offset(-0.4, 0.4);
  std::vector<Frame> drive;
  for (int i = 0; i < frames; ++i) {
    SE3 pose = level_pose(offset(random), {offset(random), offset(random), 1.0});
    pose.rotation = pose.rotation * Eigen::AngleAxisd(offset(random), Eigen::Vector3d::UnitX());
    const std::int64_t gap_ns = i > frames / 2 ? 30 * kSecond_ns : 0;
    drive.push_back({random_image(random), pose, i * kSecond_ns / 5 + gap_ns});
  }
  return drive;
}

// Coarse voxels and every pixel: quick, and many points per voxel.
inline OccupancyParams params(OccupancyPreset preset) {
  OccupancyParams p;
  apply_preset(preset, p);
  p.voxel_size_m = 0.2;
  p.pixel_step = 1;
  p.ray_step_px = 3;
  p.max_depth_m = 4.0;
  p.max_clearing_m = 3.5;
  p.max_height_m = 1.8;
  return p;
}

}  // namespace stereovox::scene
