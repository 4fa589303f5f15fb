// How uncertain a triangulated point is (method.md eqs. 3-10). Every reading of the printed
// equations can be chosen; the defaults are the corrected ones.
#pragma once

#include <Eigen/Core>
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

// The point with its errors in world axes. Disparity and sigma must be positive and finite.
PointMeasurement measure_point(const StereoErrorModel& model, const RectifiedCamera& camera,
                               const SE3& T_world_camera, const Eigen::Vector2d& pixel,
                               double disparity_px, double sigma_disparity_px);

// Error of the distance between a point and a voxel's centre, in metres; `offset_m` goes from the
// centre to the point.
double distance_error_m(DistanceError reading, const PointMeasurement& point,
                        const Eigen::Vector3d& offset_m);

}  // namespace stereovox
