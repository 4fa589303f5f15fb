// The camera's place from points of known place and their images: a closed form to start with and
// the reprojection error to be exact (vision.md 1.7, steps 6 and 7).
#pragma once

#include <span>
#include <vector>

#include "stereovox/core/camera.h"
#include "stereovox/core/parameters.h"
#include "stereovox/core/se3.h"

namespace stereovox {

// The motion T with the least sum of weights * |to - T * from|^2 (Horn 1987, Umeyama 1991). Needs
// three points that are not on a line.
SE3 closed_form_motion(std::span<const Eigen::Vector3d> from, std::span<const Eigen::Vector3d> to,
                       std::span<const double> weights);

// One point, known from a reference image, and where the current pair shows it.
struct Observation {
  Eigen::Vector3d p_reference;
  // How the point moves when the disparity it was triangulated from changes, and the error of that
  // disparity: the point itself is only measured.
  Eigen::Vector3d dp_ddisparity;
  double sigma_disparity_px;
  Eigen::Vector3d pixels;  // u_left, v, u_right
  double sigma_px;         // of each of the three
};

struct RefinementParams {
  double huber_sigmas = 1.5;
  double max_residual_px = 2.0;
  int max_iterations = 10;

  void describe(ParameterList& list) {
    list("huber_sigmas", huber_sigmas, {0.1, 100.0},
         "residuals beyond this many standard deviations count linearly only");
    list("max_residual_px", max_residual_px, {0.1, 100.0},
         "a match with a larger reprojection error is an outlier");
    list("max_iterations", max_iterations, {1, 100}, "steps of one refinement");
  }
};

struct MotionEstimate {
  SE3 T_reference_camera;
  Matrix6d covariance;  // of the twist x in T_true = T_reference_camera * exp(x)
  std::vector<bool> is_inlier;
  int inliers = 0;
  double rms_px = 0.0;  // of the inliers' residuals (u_left, v, u_right)
};

// Pixels u_left, v and u_right of a point with z > 0.
Eigen::Vector3d project_stereo(const RectifiedCamera& camera, const Eigen::Vector3d& p_camera);

// d(u_left, v, u_right) / d(point).
Eigen::Matrix3d projection_jacobian(const RectifiedCamera& camera, const Eigen::Vector3d& p_camera);

// The most likely place of the camera near `start`: robust Gauss-Newton on the reprojection error,
// weighted by the errors of pixels and points; then without the outliers again, until they stay the
// same. The covariance is sigma^2 (J^T W J)^-1 with the scatter sigma^2 of the residuals, but at
// least 1; infinite entries when fewer than three inliers remain or they do not fix the motion.
MotionEstimate refine_motion(const RectifiedCamera& camera,
                             std::span<const Observation> observations, const SE3& start,
                             const RefinementParams& params);

}  // namespace stereovox
