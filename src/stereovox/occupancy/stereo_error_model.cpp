#include "stereovox/occupancy/stereo_error_model.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace stereovox {
namespace {

double variance_along(const Eigen::Vector3d& direction, const Eigen::Matrix3d& covariance) {
  return std::max(0.0, direction.dot(covariance * direction));
}

}  // namespace

std::span<const std::string> names_of(NoiseReading) {
  static const std::vector<std::string> names = {"corrected", "printed"};
  return names;
}

std::span<const std::string> names_of(DepthVariance) {
  static const std::vector<std::string> names = {"exact", "printed"};
  return names;
}

std::span<const std::string> names_of(DistanceError) {
  static const std::vector<std::string> names = {"corrected", "printed"};
  return names;
}

void StereoErrorModel::describe(ParameterList& list) {
  list("sigma_pointing_px", sigma_pointing_px, {0, 10},
       "standard deviation of a pixel's position, p of eq. (3)");
  list("min_sigma_disparity_px", min_sigma_disparity_px, {0.01, 10},
       "smallest standard deviation of a disparity: a calibration bias does not average out");
  list("noise", noise, "eq. (3): p and m are both standard deviations, or m is a variance");
  list("depth_variance", depth_variance, "eq. (6): entry (3,3) is B f^2, or A + B f^2");
}

Eigen::Matrix3d point_covariance(const StereoErrorModel& model, const RectifiedCamera& camera,
                                 const Eigen::Vector2d& pixel, double disparity_px,
                                 double sigma_disparity_px) {
  const double m = std::max(sigma_disparity_px, model.min_sigma_disparity_px);
  const double sigma_px = model.noise == NoiseReading::corrected ? m : std::sqrt(m);
  Eigen::Matrix3d covariance = triangulation_covariance(camera, pixel.x(), pixel.y(), disparity_px,
                                                        model.sigma_pointing_px, sigma_px);
  if (model.depth_variance == DepthVariance::printed) {
    const double sqrt_A = camera.baseline_m * model.sigma_pointing_px / disparity_px;
    covariance(2, 2) += sqrt_A * sqrt_A;
  }
  return covariance;
}

MeasuringFrame measuring_frame(const StereoErrorModel& model, const RectifiedCamera& camera,
                               const SE3& T_world_camera) {
  const PinholeCamera& c = camera.pinhole;
  MeasuringFrame f;
  f.fx_px = c.fx_px, f.fy_px = c.fy_px, f.cx_px = c.cx_px, f.cy_px = c.cy_px;
  f.depth_by_disparity_mpx = c.fx_px * camera.baseline_m;
  f.variance_x = std::pow(model.sigma_pointing_px / c.fx_px, 2);
  f.variance_y = std::pow(model.sigma_pointing_px / c.fy_px, 2);
  // A = (B p / d)^2 is (p z / f)^2.
  f.variance_z = model.depth_variance == DepthVariance::printed ? f.variance_x : 0.0;
  f.min_sigma_px = model.min_sigma_disparity_px;
  f.is_sigma_a_variance = model.noise == NoiseReading::printed;
  f.R_world_camera = T_world_camera.rotation.toRotationMatrix();
  const Eigen::Vector3d variances(f.variance_x, f.variance_y, f.variance_z);
  f.lateral = f.R_world_camera * variances.asDiagonal() * f.R_world_camera.transpose();
  f.camera_world = T_world_camera.translation;
  return f;
}

PointMeasurement measure_point(const MeasuringFrame& frame, const Eigen::Vector2d& pixel,
                               double disparity_px, double sigma_disparity_px) {
  const PixelMeasurement m = measure(frame, pixel.x(), pixel.y(), disparity_px,
                                     disparity_error_px(frame, sigma_disparity_px));
  PointMeasurement point;
  point.depth_m = m.depth_m;
  point.range_m = m.range_m;
  point.sigma_range_m = std::sqrt(m.variance_range_m2);
  for (int i = 0; i < 3; ++i) {
    point.p_world[i] = position_m(frame, m, i);
    point.ray_world[i] = m.ray[i] * (m.depth_m / m.range_m);
    for (int j = 0; j < 3; ++j) point.covariance_world(i, j) = covariance_m2(frame, m, i, j);
  }
  return point;
}

PointMeasurement measure_point(const StereoErrorModel& model, const RectifiedCamera& camera,
                               const SE3& T_world_camera, const Eigen::Vector2d& pixel,
                               double disparity_px, double sigma_disparity_px) {
  return measure_point(measuring_frame(model, camera, T_world_camera), pixel, disparity_px,
                       sigma_disparity_px);
}

double distance_error_m(DistanceError reading, const PointMeasurement& point,
                        const Eigen::Vector3d& offset_m) {
  // Nearer than this to the centre, the direction to the point is no longer defined.
  constexpr double kMinDistance_m = 1e-6;
  if (reading == DistanceError::printed) return point.sigma_range_m * point.sigma_range_m;
  const double distance_m = offset_m.norm();
  const Eigen::Vector3d direction =
      distance_m < kMinDistance_m ? point.ray_world : Eigen::Vector3d(offset_m / distance_m);
  return std::sqrt(variance_along(direction, point.covariance_world));
}

}  // namespace stereovox
