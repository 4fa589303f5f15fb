#include "stereovox/simulation/rig.h"

#include <numbers>

#include "stereovox/core/angles.h"

namespace stereovox {
namespace {

Eigen::Quaterniond turn(double angle_deg, const Eigen::Vector3d& axis) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle_deg * kDegree_rad, axis));
}

// Camera axes in the robot's frame (x forward, y left, z up): x right, y down, z forward.
Eigen::Quaterniond camera_axes() {
  Eigen::Matrix3d R_base_camera;
  R_base_camera << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return Eigen::Quaterniond(R_base_camera);
}

CameraCalibration camera_of(const RigParams& params) {
  CameraCalibration camera;
  camera.pinhole = {.width = params.width_px,
                    .height = params.height_px,
                    .fx_px = params.focal_px,
                    .fy_px = params.focal_px,
                    .cx_px = (params.width_px - 1) / 2.0,
                    .cy_px = (params.height_px - 1) / 2.0};
  if (params.radial_1 == 0 && params.radial_2 == 0) return camera;
  camera.distortion_model = DistortionModel::radial_tangential;
  camera.distortion = {params.radial_1, params.radial_2, 0.0, 0.0};
  return camera;
}

}  // namespace

void RigParams::describe(ParameterList& list) {
  list("width_px", width_px, {16, 8192}, "of each image");
  list("height_px", height_px, {16, 8192}, "of each image");
  list("focal_px", focal_px, {10, 20000}, "focal length of both cameras");
  list("baseline_m", baseline_m, {0.005, 5}, "distance between the cameras");
  list("camera_height_m", camera_height_m, {0.02, 20}, "of the cameras above the floor");
  list("pitch_deg", pitch_deg, {-80, 80}, "of the cameras, positive looking down");
  list("radial_1", radial_1, {-1, 1}, "first radial distortion coefficient of both lenses");
  list("radial_2", radial_2, {-1, 1}, "second radial distortion coefficient of both lenses");
  list("toe_deg", toe_deg, {-10, 10}, "turn of the right camera towards the left one");
  list("roll_deg", roll_deg, {-10, 10}, "turn of the right camera about its optical axis");
  list("shake_deg", shake_deg, {0, 5}, "largest roll and pitch of the robot while it drives");
}

StereoRig rig_of(const RigParams& params) {
  StereoRig rig;
  rig.left = rig.right = camera_of(params);
  const SE3 T_left_right{turn(-params.toe_deg, Eigen::Vector3d::UnitY()) *
                             turn(params.roll_deg, Eigen::Vector3d::UnitZ()),
                         {params.baseline_m, 0, 0}};
  rig.T_right_left = inverse(T_left_right);
  rig.is_rectified = params.toe_deg == 0 && params.roll_deg == 0 && rig.left.distortion.empty();
  return rig;
}

SE3 camera_pose(const PlanarPose& robot, const RigParams& params, int index, std::uint32_t seed) {
  // A robot's body sways with a few frames' period; noise along time, one row for each angle.
  constexpr double kPeriod_frames = 6.0;
  const auto shake = [&](double row) {
    return 0.5 * params.shake_deg * lattice_noise({index / kPeriod_frames, row + 0.5, 0.5}, seed);
  };
  const SE3 T_world_base{turn(robot.heading_rad / kDegree_rad, Eigen::Vector3d::UnitZ()),
                         {robot.at_m.x(), robot.at_m.y(), 0.0}};
  const SE3 T_base_camera{turn(shake(0), Eigen::Vector3d::UnitX()) *
                              turn(params.pitch_deg + shake(4), Eigen::Vector3d::UnitY()) *
                              camera_axes(),
                          {0.0, params.baseline_m / 2, params.camera_height_m}};
  return T_world_base * T_base_camera;
}

}  // namespace stereovox
