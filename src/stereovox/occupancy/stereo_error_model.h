// How uncertain a triangulated point is (method.md eqs. 3-10). Every reading of the printed
// equations can be chosen; the defaults are the corrected ones.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <span>
#include <string>

#include "stereovox/core/camera.h"
#include "stereovox/core/parameters.h"

namespace stereovox {

// Eq. (3), diag(p, p, m): `corrected` takes both numbers as standard deviations in pixels and
// squares them; `printed` does so with p only and takes m as a variance, as the constants of eq.
// (6) do.
enum class NoiseReading { corrected, printed };
std::span<const std::string> names_of(NoiseReading);

// Entry (3,3) of eq. (6): B f^2 (`exact`), or A + B f^2 (`printed`).
enum class DepthVariance { exact, printed };
std::span<const std::string> names_of(DepthVariance);

// Eqs. (8)-(10): the standard deviation of the distance to the voxel's centre (`corrected`), or the
// variance of the distance to the camera, taken as metres (`printed`).
enum class DistanceError { corrected, printed };
std::span<const std::string> names_of(DistanceError);

struct StereoErrorModel {
  double sigma_pointing_px = 0.5;
  double min_sigma_disparity_px = 0.25;
  NoiseReading noise = NoiseReading::corrected;
  DepthVariance depth_variance = DepthVariance::exact;

  void describe(ParameterList& list);
};

// A pixel with disparity as a point of the world.
struct PointMeasurement {
  Eigen::Vector3d p_world;
  Eigen::Matrix3d covariance_world;  // m^2
  Eigen::Vector3d ray_world;         // unit vector from the camera to the point
  double depth_m = 0;                // along the optical axis
  double range_m = 0;                // distance from the camera
  double sigma_range_m = 0;          // its standard deviation
};

// Eq. (6). `sigma_disparity_px` is the matcher's for this pixel; the model's floor is applied here,
// because a calibration bias does not average out.
Eigen::Matrix3d point_covariance(const StereoErrorModel& model, const RectifiedCamera& camera,
                                 const Eigen::Vector2d& pixel, double disparity_px,
                                 double sigma_disparity_px);

// What measuring the points of a frame needs of its camera, pose and error model: with the ray
// e = R (a, b, 1)^T through a pixel and z = f B / d, the point is z e from the camera and its
// covariance z^2 (lateral + (m / d)^2 e e^T), which is eq. (6) turned into the world.
struct MeasuringFrame {
  double fx_px = 0, fy_px = 0, cx_px = 0, cy_px = 0;
  double depth_by_disparity_mpx = 0;      // f B
  double variance_x = 0, variance_y = 0;  // of a and b: (p / f)^2
  double variance_z = 0;                  // what DepthVariance::printed adds
  double min_sigma_px = 0;                // floor of m
  bool is_sigma_a_variance = false;       // NoiseReading::printed
  Eigen::Matrix3d R_world_camera, lateral;
  Eigen::Vector3d camera_world;
};

MeasuringFrame measuring_frame(const StereoErrorModel& model, const RectifiedCamera& camera,
                               const SE3& T_world_camera);

// m of eq. (3) for a disparity with this standard deviation, in pixels.
inline double disparity_error_px(const MeasuringFrame& f, double sigma_disparity_px) {
  const double floored_px = std::max(sigma_disparity_px, f.min_sigma_px);
  return f.is_sigma_a_variance ? std::sqrt(floored_px) : floored_px;
}

// What one pixel measures, as plain numbers. Written once for one pixel and for many at a time:
// every operation is exact to the last bit whatever the instructions.
struct PixelMeasurement {
  double depth_m, range_m, variance_range_m2;
  double ray[3];     // e, whose length is range / depth
  double ray_error;  // m / d
};

[[gnu::always_inline]] inline PixelMeasurement measure(const MeasuringFrame& f, double u_px,
                                                       double v_px, double disparity_px,
                                                       double error_px) {
  const double a = (u_px - f.cx_px) / f.fx_px, b = (v_px - f.cy_px) / f.fy_px;
  const double inverse_disparity = 1.0 / disparity_px;
  const double length2 = (a * a + b * b) + 1.0;

  PixelMeasurement m;
  m.depth_m = f.depth_by_disparity_mpx * inverse_disparity;
  m.range_m = m.depth_m * std::sqrt(length2);
  m.ray_error = error_px * inverse_disparity;
  const double lateral = ((f.variance_x * a * a + f.variance_y * b * b) + f.variance_z) / length2;
  m.variance_range_m2 = m.depth_m * m.depth_m * (lateral + m.ray_error * m.ray_error * length2);
  for (int k = 0; k < 3; ++k)
    m.ray[k] = f.R_world_camera(k, 0) * a + (f.R_world_camera(k, 1) * b + f.R_world_camera(k, 2));
  return m;
}

// Its coordinate along axis k of the world, and the variance of that.
[[gnu::always_inline]] inline double position_m(const MeasuringFrame& f, const PixelMeasurement& m,
                                                int k) {
  return m.depth_m * m.ray[k] + f.camera_world[k];
}
[[gnu::always_inline]] inline double covariance_m2(const MeasuringFrame& f,
                                                   const PixelMeasurement& m, int i, int j) {
  return m.depth_m * m.depth_m *
         (f.lateral(i, j) + m.ray_error * m.ray_error * (m.ray[i] * m.ray[j]));
}

// The point with its errors in world axes. Disparity and sigma must be positive and finite.
PointMeasurement measure_point(const MeasuringFrame& frame, const Eigen::Vector2d& pixel,
                               double disparity_px, double sigma_disparity_px);
PointMeasurement measure_point(const StereoErrorModel& model, const RectifiedCamera& camera,
                               const SE3& T_world_camera, const Eigen::Vector2d& pixel,
                               double disparity_px, double sigma_disparity_px);

// Error of the distance between a point and a voxel's centre, in metres; `offset_m` goes from the
// centre to the point.
double distance_error_m(DistanceError reading, const PointMeasurement& point,
                        const Eigen::Vector3d& offset_m);

}  // namespace stereovox
