// The cameras of a simulated robot, and what they do to the light.
#pragma once

#include <vector>

#include "stereovox/core/camera.h"
#include "stereovox/core/parameters.h"
#include "stereovox/simulation/drive.h"

namespace stereovox {

// The left camera looks ahead of the robot, above its centre; the right one lies to its right.
struct RigParams {
  int width_px = 640, height_px = 480;
  double focal_px = 525.0;
  double baseline_m = 0.12;
  double camera_height_m = 0.62;
  double pitch_deg = 4.0;  // down
  double radial_1 = 0.0, radial_2 = 0.0;
  double toe_deg = 0.0, roll_deg = 0.0;
  double shake_deg = 0.1;

  void describe(ParameterList& list);
};

// Rectified unless the lenses distort or the right camera is turned.
StereoRig rig_of(const RigParams& params);

// Pose of the left camera; frame `index` fixes the shaking.
SE3 camera_pose(const PlanarPose& robot, const RigParams& params, int index, std::uint32_t seed);

}  // namespace stereovox
