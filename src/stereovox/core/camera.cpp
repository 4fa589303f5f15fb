#include "stereovox/core/camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "stereovox/core/error.h"

namespace stereovox {
namespace {

constexpr double kMinBaseline_m = 0.005, kMaxBaseline_m = 10.0;
constexpr double kMinUsualBaseline_m = 0.01, kMaxUsualBaseline_m = 3.0;
// Calibration files round their matrices; 1e-3 forgives three digits and catches a wrong entry.
constexpr double kRotationTolerance = 1e-3;
// Share of the baseline that must lie along the left camera's x axis: beside it, within 45 degrees.
constexpr double kMinSideways_share = 0.7;
constexpr int kMaxSide_px = 16384;

struct Checker {
  std::string source;

  [[noreturn]] void fail(const std::string& what) const { throw Error(source + ": " + what); }
  void finite(const char* camera, const char* name, double value) const {
    if (!std::isfinite(value)) fail(fmt::format("{} {} is {}", camera, name, value));
  }
};

void check_pinhole(const Checker& check, const char* name, const PinholeCamera& c) {
  if (c.width < 1 || c.height < 1 || c.width > kMaxSide_px || c.height > kMaxSide_px)
    check.fail(fmt::format("{} image size is {} x {}", name, c.width, c.height));
  check.finite(name, "fx", c.fx_px);
  check.finite(name, "fy", c.fy_px);
  check.finite(name, "cx", c.cx_px);
  check.finite(name, "cy", c.cy_px);
  if (c.fx_px <= 0.0 || c.fy_px <= 0.0)
    check.fail(fmt::format("{} focal lengths are {} and {}, both must be positive", name, c.fx_px,
                           c.fy_px));
  if (c.cx_px < 0.0 || c.cy_px < 0.0 || c.cx_px > c.width || c.cy_px > c.height)
    check.fail(fmt::format("{} principal point ({}, {}) is outside the image of {} x {}", name,
                           c.cx_px, c.cy_px, c.width, c.height));
}

bool is_known_count(DistortionModel model, std::size_t count) {
  constexpr std::array<std::size_t, 4> radial_tangential = {4, 5, 8, 12};
  switch (model) {
    case DistortionModel::none:
      return count == 0;
    case DistortionModel::equidistant:
      return count == 4;
    case DistortionModel::radial_tangential:
      return std::ranges::count(radial_tangential, count) > 0;
  }
  return false;
}

void check_camera(const Checker& check, const char* name, const CameraCalibration& camera) {
  check_pinhole(check, name, camera.pinhole);
  for (const double k : camera.distortion) check.finite(name, "distortion coefficient", k);
  if (!is_known_count(camera.distortion_model, camera.distortion.size()))
    check.fail(fmt::format("{} has {} distortion coefficients, the model does not take that many",
                           name, camera.distortion.size()));
}

void check_baseline(const Checker& check, const StereoRig& rig) {
  const Eigen::Vector3d t = rig.T_right_left.translation;
  if (!is_finite(rig.T_right_left))
    check.fail(fmt::format("translation between the cameras is ({}, {}, {})", t.x(), t.y(), t.z()));
  const double baseline_m = rig.baseline_m();
  if (baseline_m == 0.0) check.fail("baseline is 0 m");
  const Eigen::Vector3d right_in_left = inverse(rig.T_right_left).translation;
  if (right_in_left.x() <= 0.0)
    check.fail(
        fmt::format("right camera is {:.4g} m to the left of the left camera; are the cameras "
                    "swapped or the sign of the baseline wrong?",
                    -right_in_left.x()));
  if (right_in_left.x() < kMinSideways_share * baseline_m)
    check.fail(fmt::format("right camera is at ({:.4g}, {:.4g}, {:.4g}) m, not beside the left one",
                           right_in_left.x(), right_in_left.y(), right_in_left.z()));
  if (baseline_m < kMinBaseline_m || baseline_m > kMaxBaseline_m)
    check.fail(fmt::format("baseline is {:.6g} m, outside [{}, {}] m; is it in millimetres?",
                           baseline_m, kMinBaseline_m, kMaxBaseline_m));
}

}  // namespace

Eigen::Vector2d project(const PinholeCamera& camera, const Eigen::Vector3d& p) {
  return {camera.fx_px * p.x() / p.z() + camera.cx_px, camera.fy_px * p.y() / p.z() + camera.cy_px};
}

Eigen::Vector3d triangulate(const RectifiedCamera& camera, double u_px, double v_px,
                            double disparity_px) {
  const PinholeCamera& c = camera.pinhole;
  const double z = camera.depth_m(disparity_px);
  return {z * (u_px - c.cx_px) / c.fx_px, z * (v_px - c.cy_px) / c.fy_px, z};
}

Eigen::Matrix3d triangulation_covariance(const RectifiedCamera& camera, double u_px, double v_px,
                                         double disparity_px, double sigma_pointing_px,
                                         double sigma_disparity_px) {
  const PinholeCamera& c = camera.pinhole;
  const double z = camera.depth_m(disparity_px);
  const Eigen::Vector3d ray((u_px - c.cx_px) / c.fx_px, (v_px - c.cy_px) / c.fy_px, 1.0);
  // The columns of J (eq. 5) are z/fx e_x, z/fy e_y and -z/d ray.
  const Eigen::Vector3d along_ray = sigma_disparity_px * z / disparity_px * ray;
  Eigen::Matrix3d covariance = along_ray * along_ray.transpose();
  const double across_x = sigma_pointing_px * z / c.fx_px;
  const double across_y = sigma_pointing_px * z / c.fy_px;
  covariance(0, 0) += across_x * across_x;
  covariance(1, 1) += across_y * across_y;
  return covariance;
}

void validate(const StereoRig& rig, const std::string& source) {
  const Checker check{source};
  check_camera(check, "left camera:", rig.left);
  check_camera(check, "right camera:", rig.right);
  if (rig.left.pinhole.width != rig.right.pinhole.width ||
      rig.left.pinhole.height != rig.right.pinhole.height)
    check.fail(fmt::format("left images are {} x {}, right images {} x {}", rig.left.pinhole.width,
                           rig.left.pinhole.height, rig.right.pinhole.width,
                           rig.right.pinhole.height));
  const NearestRotation nearest = nearest_rotation(rig.T_right_left.rotation.toRotationMatrix());
  if (nearest.residual > kRotationTolerance)
    check.fail("rotation between the cameras is not a rotation");
  check_baseline(check, rig);
}

std::vector<std::string> oddities(const StereoRig& rig) {
  std::vector<std::string> found;
  const double baseline_m = rig.baseline_m();
  if (baseline_m < kMinUsualBaseline_m || baseline_m > kMaxUsualBaseline_m)
    found.push_back(
        fmt::format("baseline of {:.4g} m is unusual (usual: {} to {} m); is the unit right?",
                    baseline_m, kMinUsualBaseline_m, kMaxUsualBaseline_m));
  return found;
}

}  // namespace stereovox
