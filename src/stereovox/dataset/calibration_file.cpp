#include "stereovox/dataset/calibration_file.h"

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

#include "stereovox/core/error.h"
#include "stereovox/dataset/calibration.h"
#include "stereovox/dataset/calibration_parts.h"
#include "stereovox/dataset/euroc_layout.h"

namespace stereovox {
namespace {

namespace fs = std::filesystem;

using ImageSize = std::function<cv::Size()>;

// The first of these keys that the map has; "" when there is none.
std::string key_of(const YAML::Node& map, const std::vector<std::string>& names) {
  for (const std::string& name : names)
    if (map[name].IsDefined()) return name;
  return "";
}

// The file beside this one in whose name the last `old_part` is another.
fs::path sibling(const fs::path& path, const std::string& old_part, const std::string& new_part) {
  std::string name = path.filename().string();
  const std::size_t at = name.rfind(old_part);
  if (at == std::string::npos) return {};
  return path.parent_path() / name.replace(at, old_part.size(), new_part);
}

// ---- Kalibr

StereoRig kalibr_rig(const YAML::Node& chain, const std::string& source) {
  const YAML::Node left = yaml_value(chain, "cam0", source);
  const YAML::Node right = yaml_value(chain, "cam1", source);
  return {pinhole_calibration(left, "distortion_coeffs", source),
          pinhole_calibration(right, "distortion_coeffs", source),
          yaml_rigid_motion(right, "T_cn_cnm1", source)};
}

// ---- ROS camera_info

struct CameraInfo {
  CameraCalibration calibration;
  Eigen::Quaterniond R_rectified_camera;
  std::vector<double> P;  // projection of the rectified camera, 3x4
};

CameraInfo read_camera_info(const fs::path& path) {
  const std::string source = path.string();
  const YAML::Node info = load_yaml(path);
  const std::vector<double> K = yaml_matrix(info, "camera_matrix", 9, source);
  CameraInfo camera;
  camera.calibration.pinhole = {yaml_integer(info, "image_width", source),
                                yaml_integer(info, "image_height", source),
                                K[0],
                                K[4],
                                K[2],
                                K[5]};
  camera.calibration.distortion_model =
      distortion_model_of(yaml_text(info, "distortion_model", source), source);
  camera.calibration.distortion =
      yaml_numbers(yaml_value(info, "distortion_coefficients", source), "data", source);
  camera.R_rectified_camera = yaml_rotation(info, "rectification_matrix", source);
  camera.P = yaml_matrix(info, "projection_matrix", 12, source);
  return camera;
}

StereoRig ros_rig(const fs::path& left_path, const fs::path& right_path) {
  const CameraInfo left = read_camera_info(left_path), right = read_camera_info(right_path);
  if (!(right.P[3] < 0.0))
    throw Error(fmt::format(
        "{}: the fourth entry of 'projection_matrix' is {:.6g}; that of the right camera is "
        "-fx baseline, so negative. Are left and right exchanged?",
        right_path.string(), right.P[3]));
  const SE3 T_right_rectified{right.R_rectified_camera.inverse(), Eigen::Vector3d::Zero()};
  const SE3 T_rectified_left{left.R_rectified_camera, {right.P[3] / right.P[0], 0.0, 0.0}};
  return {left.calibration, right.calibration, T_right_rectified * T_rectified_left};
}

StereoRig ros_rig_of(const fs::path& one) {
  const fs::path right = sibling(one, "left", "right"), left = sibling(one, "right", "left");
  if (!right.empty()) return ros_rig(one, right);
  if (!left.empty()) return ros_rig(left, one);
  throw Error(
      fmt::format("{}: is a camera_info of one camera; name its files left.yaml and "
                  "right.yaml, and give either",
                  one.string()));
}

// ---- OpenCV

const std::vector<std::string> kOpenCvMatrices[] = {
    {"M1", "K1", "cameraMatrix1", "camera_matrix_1"},
    {"M2", "K2", "cameraMatrix2", "camera_matrix_2"}};
const std::vector<std::string> kOpenCvDistortions[] = {{"D1", "distCoeffs1", "dist_coeffs_1"},
                                                       {"D2", "distCoeffs2", "dist_coeffs_2"}};

bool has_opencv_intrinsics(const YAML::Node& map) {
  return !key_of(map, kOpenCvMatrices[0]).empty();
}
bool has_opencv_extrinsics(const YAML::Node& map) {
  return map["R"].IsDefined() && map["T"].IsDefined();
}

// The tilted sensor of OpenCV's longest model, and thin prisms, are not modelled here.
std::vector<double> without_zeros_beyond_8(std::vector<double> coefficients) {
  constexpr std::size_t kMost = 8;
  while (coefficients.size() > kMost && coefficients.back() == 0.0) coefficients.pop_back();
  return coefficients;
}

CameraCalibration opencv_camera(const YAML::Node& intrinsics, std::size_t camera, cv::Size size,
                                const std::string& source) {
  const auto named = [&](const std::vector<std::string>& names) {
    const std::string key = key_of(intrinsics, names);
    return key.empty() ? names.front() : key;
  };
  const std::vector<double> K = yaml_matrix(intrinsics, named(kOpenCvMatrices[camera]), 9, source);
  const std::string key = named(kOpenCvDistortions[camera]);
  const YAML::Node D = yaml_value(intrinsics, key, source);
  return {{size.width, size.height, K[0], K[4], K[2], K[5]},
          DistortionModel::radial_tangential,
          without_zeros_beyond_8(D.IsMap() ? yaml_numbers(D, "data", source)
                                           : yaml_numbers(intrinsics, key, source))};
}

StereoRig opencv_rig(const fs::path& intrinsics_path, const fs::path& extrinsics_path,
                     const ImageSize& image_size) {
  const YAML::Node intrinsics = load_yaml(intrinsics_path), extrinsics = load_yaml(extrinsics_path);
  const std::string source = extrinsics_path.string();
  const std::vector<double> T = yaml_matrix(extrinsics, "T", 3, source);
  const cv::Size size = image_size();
  return {opencv_camera(intrinsics, 0, size, intrinsics_path.string()),
          opencv_camera(intrinsics, 1, size, intrinsics_path.string()),
          {yaml_rotation(extrinsics, "R", source), {T[0], T[1], T[2]}}};
}

StereoRig opencv_rig_of(const fs::path& path, const YAML::Node& root, const ImageSize& image_size) {
  const bool has_intrinsics = has_opencv_intrinsics(root);
  if (has_intrinsics && has_opencv_extrinsics(root)) return opencv_rig(path, path, image_size);
  std::string here = "intrinsics", there = "extrinsics";
  if (!has_intrinsics) std::swap(here, there);
  const fs::path other = sibling(path, here, there);
  if (other.empty() || !fs::exists(other))
    throw Error(
        fmt::format("{}: holds the {} only; the {} are looked for in a file beside it "
                    "whose name says {} instead of {}",
                    path.string(), here, there, there, here));
  return has_intrinsics ? opencv_rig(path, other, image_size) : opencv_rig(other, path, image_size);
}

// ---- all

StereoRig kitti_rig_of(const fs::path& path, const ImageSize& image_size) {
  return read_kitti_calibration(path, 0, 1, image_size()).rig;
}

StereoRig rig_of_yaml(const fs::path& path, const ImageSize& image_size) {
  const YAML::Node root = load_yaml(path);
  if (!root.IsMap()) throw Error(path.string() + ": is no calibration (no keys with values)");
  if (root["cam0"].IsDefined()) return kalibr_rig(root, path.string());
  if (root["camera_matrix"].IsDefined()) return ros_rig_of(path);
  if (root["T_BS"].IsDefined()) return euroc_rig(path.parent_path().parent_path());
  if (has_opencv_intrinsics(root) || has_opencv_extrinsics(root))
    return opencv_rig_of(path, root, image_size);
  return read_plain_calibration(path);
}

StereoRig rig_of_folder(const fs::path& folder, const ImageSize& image_size) {
  for (const char* const name :
       {"calib.yaml", "camchain.yaml", "left.yaml", "intrinsics.yml", "intrinsics.yaml"})
    if (fs::exists(folder / name)) return rig_of_yaml(folder / name, image_size);
  if (fs::exists(folder / "calib.txt")) return kitti_rig_of(folder / "calib.txt", image_size);
  if (is_euroc_layout(folder)) return euroc_rig(folder);
  throw Error(fmt::format(
      "{}: holds no calibration; looked for calib.yaml, camchain.yaml (Kalibr), left.yaml and "
      "right.yaml (ROS), intrinsics.yml and extrinsics.yml (OpenCV), calib.txt (KITTI), cam0/ and "
      "cam1/ (EuRoC/ASL)",
      folder.string()));
}

}  // namespace

StereoRig read_calibration(const fs::path& path, const ImageSize& image_size) {
  if (!fs::exists(path))
    throw Error(path.string() + ": cannot be opened (No such file or directory)");
  StereoRig rig = fs::is_directory(path)       ? rig_of_folder(path, image_size)
                  : path.extension() == ".txt" ? kitti_rig_of(path, image_size)
                                               : rig_of_yaml(path, image_size);
  rig.is_rectified = is_rectified(rig);
  return rig;
}

}  // namespace stereovox
