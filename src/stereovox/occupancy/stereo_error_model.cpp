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

PointMeasurement measure_point(const StereoErrorModel& model, const RectifiedCamera& camera,
                               const SE3& T_world_camera, const Eigen::Vector2d& pixel,
                               double disparity_px, double sigma_disparity_px) {
  const Eigen::Vector3d p_camera = triangulate(camera, pixel.x(), pixel.y(), disparity_px);
  const Eigen::Matrix3d covariance_camera =
      point_covariance(model, camera, pixel, disparity_px, sigma_disparity_px);
  const Eigen::Matrix3d R_world_camera = T_world_camera.rotation.toRotationMatrix();

  PointMeasurement point;
  point.depth_m = p_camera.z();
  point.range_m = p_camera.norm();
  point.sigma_range_m = std::sqrt(variance_along(p_camera / point.range_m, covariance_camera));
  point.p_world = R_world_camera * p_camera + T_world_camera.translation;
  point.ray_world = R_world_camera * (p_camera / point.range_m);
  point.covariance_world = R_world_camera * covariance_camera * R_world_camera.transpose();
  return point;
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
