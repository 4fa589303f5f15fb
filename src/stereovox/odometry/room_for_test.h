// A room with textured walls, floor and ceiling around the origin, seen by a camera of known place.
#pragma once

#include <cmath>
#include <random>

#include "stereovox/core/camera.h"
#include "stereovox/core/frame.h"
#include "stereovox/core/se3.h"
#include "stereovox/core/timestamp.h"

namespace stereovox {

inline const RectifiedCamera kCamera{{240, 160, 200.0, 200.0, 119.5, 79.5}, 0.12};
inline constexpr double kFramesPerSecond = 10.0;

inline double lattice(int x, int y, int z) {
  std::uint32_t h = static_cast<std::uint32_t>(x) * 73856093U ^
                    static_cast<std::uint32_t>(y) * 19349663U ^
                    static_cast<std::uint32_t>(z) * 83492791U;
  h = (h ^ (h >> 13)) * 0x5bd1e995U;
  return static_cast<double>((h ^ (h >> 15)) & 0xffffU) / 65535.0;
}

// Smooth noise in [0, 1] with features of the size `cell_m`.
inline double texture(const Eigen::Vector3d& p, double cell_m) {
  const Eigen::Vector3d q = p / cell_m;
  const Eigen::Vector3i i = q.array().floor().cast<int>();
  const Eigen::Array3d t = (q - i.cast<double>()).array();
  const Eigen::Array3d s = t * t * (3.0 - 2.0 * t);
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Array3i bit(corner & 1, corner >> 1 & 1, corner >> 2);
    const Eigen::Array3d w = bit.cast<double>() * s + (1 - bit.cast<double>()) * (1.0 - s);
    sum += w.prod() * lattice(i.x() + bit.x(), i.y() + bit.y(), i.z() + bit.z());
  }
  return sum;
}

// How far along a ray from inside the room its wall is.
inline double distance_to_wall(const Eigen::Vector3d& from, const Eigen::Vector3d& direction) {
  const Eigen::Array3d half_size_m(3.0, 1.5, 4.0);
  const Eigen::Array3d wall = direction.array().sign() * half_size_m;
  return ((wall - from.array()) / direction.array()).minCoeff();
}

struct View {
  cv::Mat1b brightness = cv::Mat1b(kCamera.pinhole.height, kCamera.pinhole.width);
  cv::Mat1f depth_m = cv::Mat1f(kCamera.pinhole.height, kCamera.pinhole.width);
};

// How the walls are painted: everywhere alike, with large clouds from some x on, or with a pattern
// that comes again along x, laid over faint clouds.
struct Paint {
  double plain_from_x_m = 1e9;
  double period_m = 0.0;  // 0 = no such pattern

  double brightness(const Eigen::Vector3d& p) const {
    if (period_m > 0.0) {
      const Eigen::Vector3d once(p.x() - period_m * std::floor(p.x() / period_m), p.y(), p.z());
      return 40.0 + 80.0 * texture(once, 0.1) + 15.0 * texture(p, 0.8) + 12.0 * texture(p, 0.6);
    }
    return p.x() > plain_from_x_m ? 50.0 + 70.0 * texture(p, 1.0) + 40.0 * texture(p, 0.5)
                                  : 30.0 + 110.0 * texture(p, 0.3) + 90.0 * texture(p, 0.12);
  }
};

inline View view_from(const SE3& T_world_camera, const Paint& paint, std::mt19937& random) {
  std::normal_distribution<double> noise(0.0, 1.0);
  View view;
  for (int v = 0; v < view.brightness.rows; ++v)
    for (int u = 0; u < view.brightness.cols; ++u) {
      const auto& pinhole = kCamera.pinhole;
      const Eigen::Vector3d ray =
          T_world_camera.rotation * Eigen::Vector3d((u - pinhole.cx_px) / pinhole.fx_px,
                                                    (v - pinhole.cy_px) / pinhole.fy_px, 1.0);
      const double depth_m = distance_to_wall(T_world_camera.translation, ray);
      const Eigen::Vector3d p = T_world_camera.translation + depth_m * ray;
      view.brightness(v, u) = cv::saturate_cast<std::uint8_t>(paint.brightness(p) + noise(random));
      view.depth_m(v, u) = static_cast<float>(depth_m);
    }
  return view;
}

struct Shot {
  RectifiedPair pair;
  DisparityImage disparity;
};

// Noise of image and disparity differs with the number of the frame.
inline Shot shot_from(const SE3& T_world_camera, int frame, const Paint& paint = {}) {
  std::mt19937 random(static_cast<unsigned>(frame));
  const View left = view_from(T_world_camera, paint, random);
  const SE3 T_left_right{Eigen::Quaterniond::Identity(), {kCamera.baseline_m, 0, 0}};
  const View right = view_from(T_world_camera * T_left_right, paint, random);
  Shot shot;
  shot.pair.stamp_ns = ns_from_seconds(frame / kFramesPerSecond);
  shot.pair.left.pixels = left.brightness;
  shot.pair.right.pixels = right.brightness;
  shot.disparity = {cv::Mat1f(left.depth_m.size()), cv::Mat1f(left.depth_m.size(), 0.35F)};
  std::normal_distribution<float> noise(0.0F, 0.2F);
  for (int v = 0; v < left.depth_m.rows; ++v)
    for (int u = 0; u < left.depth_m.cols; ++u)
      shot.disparity.disparity_px(v, u) =
          static_cast<float>(kCamera.disparity_px(left.depth_m(v, u))) + noise(random);
  return shot;
}

}  // namespace stereovox
