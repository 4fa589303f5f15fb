// What the readers of calibration files have in common.
#pragma once

#include <string>
#include <vector>

#include "stereovox/core/camera.h"
#include "stereovox/io/yaml_file.h"

namespace stereovox {

// By the names that ASL, Kalibr and ROS give them.
DistortionModel distortion_model_of(const std::string& name, const std::string& source);

// A camera that is described as ASL and Kalibr do: camera_model (pinhole), resolution, intrinsics,
// distortion_model and, under this key, its coefficients.
CameraCalibration pinhole_calibration(const YAML::Node& camera, const std::string& coefficients_key,
                                      const std::string& source);

// A matrix under a key: numbers, flat or nested, or OpenCV's {rows, cols, data}.
std::vector<double> yaml_matrix(const YAML::Node& map, const std::string& key, std::size_t count,
                                const std::string& source);

// The 3x3 rotation, or 4x4 rigid motion, that such a matrix holds up to rounding.
Eigen::Quaterniond yaml_rotation(const YAML::Node& map, const std::string& key,
                                 const std::string& source);
SE3 yaml_rigid_motion(const YAML::Node& map, const std::string& key, const std::string& source);

// Whether images of the rig need no warping.
bool is_rectified(const StereoRig& rig);

}  // namespace stereovox
