// Cameras and what follows from their geometry (method.md A, eqs. 2-6).
// Camera frame: x right, y down, z forward. Pixel (0,0) is the centre of the upper-left pixel.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "stereovox/core/se3.h"

namespace stereovox {

struct PinholeCamera {
  int width = 0, height = 0;
  double fx_px = 0, fy_px = 0, cx_px = 0, cy_px = 0;
};

enum class DistortionModel {
  none,
  radial_tangential,  // k1 k2 p1 p2 [k3 [k4 k5 k6]]: OpenCV's order (plumb_bob,
                      // rational_polynomial)
  equidistant,        // k1 k2 k3 k4: Kannala-Brandt, cv::fisheye
};

// One camera as calibrated.
struct CameraCalibration {
  PinholeCamera pinhole;
  DistortionModel distortion_model = DistortionModel::none;
  std::vector<double> distortion;
};

// Both cameras as calibrated; the images may be distorted and not yet aligned.
struct StereoRig {
  CameraCalibration left, right;
  SE3 T_right_left;           // its translation is (-baseline, 0, 0) when the rig is rectified
  bool is_rectified = false;  // images need no warping: equal pinholes, no distortion, no rotation

  double baseline_m() const { return T_right_left.translation.norm(); }
};

// A rectified pair: one pinhole for both cameras, the right one `baseline_m` along +x.
struct RectifiedCamera {
  PinholeCamera pinhole;
  double baseline_m = 0;

  // Depth along the optical axis for a disparity > 0, and back (eq. 2: z = f b / d).
  double depth_m(double disparity_px) const { return pinhole.fx_px * baseline_m / disparity_px; }
  double disparity_px(double depth) const { return pinhole.fx_px * baseline_m / depth; }
};

// Pixel of a point with z > 0.
Eigen::Vector2d project(const PinholeCamera& camera, const Eigen::Vector3d& p_camera);

// Point seen at pixel (u, v) with disparity > 0 (eq. 2; u, v are taken relative to the principal
// point as the equation needs).
Eigen::Vector3d triangulate(const RectifiedCamera& camera, double u_px, double v_px,
                            double disparity_px);

// First-order covariance of that point (eqs. 3-6, corrected): C_X = J diag(sp^2, sp^2, sm^2) J^T
// with the standard deviations of the pixel position and of the disparity.
Eigen::Matrix3d triangulation_covariance(const RectifiedCamera& camera, double u_px, double v_px,
                                         double disparity_px, double sigma_pointing_px,
                                         double sigma_disparity_px);

// Throws Error "<source>: ..." when a rig cannot be used: numbers that are not finite, sizes, focal
// lengths or principal points outside the image, distortion counts, a rotation that is none, a
// right camera that is not to the right, a baseline outside [0.005, 10] m (in millimetres?).
void validate(const StereoRig& rig, const std::string& source);

// Warnings for a rig that is usable but odd (a baseline outside [0.01, 3] m); empty when there are
// none.
std::vector<std::string> oddities(const StereoRig& rig);

}  // namespace stereovox
