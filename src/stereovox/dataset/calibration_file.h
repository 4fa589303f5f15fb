// Calibration files of any form that users bring, told apart by what is in them.
#pragma once

#include <filesystem>
#include <functional>
#include <opencv2/core/types.hpp>

#include "stereovox/core/camera.h"

namespace stereovox {

// The rig in a file, or in a folder with the files of both cameras:
//
//   plain            calib.yaml: width height fx fy cx cy baseline
//   Kalibr           camchain.yaml: cam0 and cam1, pinhole with radtan or equidistant distortion
//   ROS camera_info  left.yaml and right.yaml, as camera_calibration writes them; either is enough
//   OpenCV           intrinsics.yml (M1 D1 M2 D2) and extrinsics.yml (R T), or all in one
//   KITTI            calib.txt: P0 and P1
//   EuRoC/ASL        cam0/sensor.yaml and cam1/sensor.yaml
//
// `image_size` is asked where the files do not tell: for OpenCV and KITTI. Throws Error; the rig is
// not validated yet.
StereoRig read_calibration(const std::filesystem::path& path,
                           const std::function<cv::Size()>& image_size);

}  // namespace stereovox
