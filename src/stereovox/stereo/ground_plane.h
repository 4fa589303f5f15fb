// The floor as the camera sees it: how high the camera is and how it is tilted.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "stereovox/core/camera.h"
#include "stereovox/core/image.h"
#include "stereovox/core/parameters.h"

namespace stereovox {

struct GroundPlaneParams {
  double min_height_m = 0.05;
  double max_height_m = 3.0;
  double max_tilt_deg = 35.0;
  double max_roll_deg = 20.0;
  double tolerance_px = 1.0;
  double min_share_percent = 10.0;

  void describe(ParameterList& list) {
    list("min_height_m", min_height_m, {0.0, 100.0},
         "a plane nearer to the camera is not the floor");
    list("max_height_m", max_height_m, {0.0, 100.0}, "a plane farther below is not the floor");
    list("max_tilt_deg", max_tilt_deg, {0.0, 89.0}, "largest pitch of the camera, up or down");
    list("max_roll_deg", max_roll_deg, {0.0, 89.0}, "largest roll of the camera");
    list("tolerance_px", tolerance_px, {0.1, 10.0},
         "disparities this near to the plane belong to it");
    list("min_share_percent", min_share_percent, {1.0, 100.0},
         "share of the disparities in the lower half of the image that must lie on the floor");
  }
};

struct GroundPlane {
  Eigen::Vector3d down_camera;  // unit normal of the floor, pointing down, in the camera frame
  double height_m = 0;          // of the camera above the floor
  double share = 0;             // of the lower half's disparities that lie on the floor
};

// Fits a plane to the disparities of the lower half of the image by RANSAC (fixed seed) and least
// squares, in (u, v, disparity), where a plane is a plane and the noise is uniform. Nothing when no
// plane within the limits holds enough of the disparities.
std::optional<GroundPlane> estimate_ground_plane(const DisparityImage& disparity,
                                                 const RectifiedCamera& camera,
                                                 const GroundPlaneParams& params);

}  // namespace stereovox
