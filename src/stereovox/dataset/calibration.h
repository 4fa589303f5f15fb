// Calibration files of the layouts, as stereo rigs. What does not depend on the numbers fitting
// together is checked here; validate() of core/camera.h checks the rest.
#pragma once

#include <filesystem>
#include <opencv2/core/types.hpp>
#include <string>

#include "stereovox/core/camera.h"

namespace stereovox {

// The plain form: `width height fx fy cx cy` of both rectified cameras in pixels and `baseline` in
// metres, as YAML. An optional `doffs` (Middlebury) is the right camera's cx minus the left one's.
StereoRig read_plain_calibration(const std::filesystem::path& path);

// KITTI's calib.txt: rows `P0:` to `P3:` of twelve numbers, the 3x4 projections of four rectified
// cameras. `left` and `right` number two of them; the baseline is (P_left[3] - P_right[3]) / P[0].
struct KittiCalibration {
  StereoRig rig;
  SE3 T_cam0_left;  // poses are of camera 0
};
KittiCalibration read_kitti_calibration(const std::filesystem::path& path, int left, int right,
                                        cv::Size image_size);

// A camera's sensor.yaml of the ASL format: pinhole with radial-tangential, equidistant or no
// distortion, and T_BS (4x4, sensor to body; flat, nested or {cols, rows, data}).
struct AslCamera {
  CameraCalibration calibration;
  SE3 T_body_camera;
};
AslCamera read_asl_camera(const std::filesystem::path& sensor_yaml);

// The rig of two such cameras; marked as rectified when it is.
StereoRig stereo_rig(const AslCamera& left, const AslCamera& right);

}  // namespace stereovox
