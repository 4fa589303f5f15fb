#include "stereovox/dataset/calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "stereovox/core/error.h"
#include "stereovox/dataset/calibration_parts.h"
#include "stereovox/io/text_file.h"
#include "stereovox/io/yaml_file.h"

namespace stereovox {
namespace {

// Calibration files round their matrices; 1e-3 forgives three digits and catches a wrong entry.
constexpr double kRotationTolerance = 1e-3;
// Angles and offsets that no pixel of any camera can show.
constexpr double kRectifiedTolerance_rad = 1e-6, kRectifiedTolerance_m = 1e-6;

using Projection = std::array<double, 12>;  // 3x4, row by row

std::map<std::string, Projection> read_projections(const std::filesystem::path& path) {
  std::map<std::string, Projection> projections;
  for_each_record(path, [&](const TextRecord& record) {
    if (!record.fields[0].starts_with('P')) return;  // Tr and others are not needed
    record.expect_fields(13);
    Projection& P = projections[std::string(record.fields[0])];
    for (std::size_t i = 0; i < P.size(); ++i) P[i] = record.number(i + 1);
  });
  return projections;
}

const Projection& find_projection(const std::map<std::string, Projection>& projections, int camera,
                                  const std::string& source) {
  const auto found = projections.find(fmt::format("P{}:", camera));
  if (found == projections.end()) throw Error(fmt::format("{}: 'P{}:' is missing", source, camera));
  return found->second;
}

PinholeCamera pinhole_of(const Projection& P, cv::Size size) {
  return {size.width, size.height, P[0], P[5], P[2], P[6]};
}

// Where camera 0's origin lies in this camera: K^-1 times the fourth column.
Eigen::Vector3d offset_from_camera_0(const Projection& P) {
  return {(P[3] - P[2] * P[11]) / P[0], (P[7] - P[6] * P[11]) / P[5], P[11]};
}

bool has_no_distortion(const CameraCalibration& camera) {
  return camera.distortion_model != DistortionModel::equidistant &&
         std::ranges::all_of(camera.distortion, [](double k) { return k == 0.0; });
}

Eigen::Quaterniond rotation_of(const Eigen::Matrix3d& matrix, const std::string& key,
                               const std::string& source) {
  const NearestRotation nearest = nearest_rotation(matrix);
  if (nearest.residual > kRotationTolerance)
    throw Error(fmt::format("{}: the rotation in '{}' is none (R R^T differs from I by {:.3g})",
                            source, key, nearest.residual));
  return nearest.rotation;
}

}  // namespace

DistortionModel distortion_model_of(const std::string& name, const std::string& source) {
  for (const char* const known :
       {"radial-tangential", "radtan", "plumb_bob", "rational_polynomial"})
    if (name == known) return DistortionModel::radial_tangential;
  if (name == "equidistant") return DistortionModel::equidistant;
  if (name == "none") return DistortionModel::none;
  throw Error(fmt::format("{}: distortion model {} is none of radial-tangential, equidistant, none",
                          source, in_quotes(name)));
}

CameraCalibration pinhole_calibration(const YAML::Node& camera, const std::string& coefficients_key,
                                      const std::string& source) {
  const std::string model = yaml_text(camera, "camera_model", source);
  if (model != "pinhole")
    throw Error(fmt::format("{}: camera model {} is not 'pinhole'", source, in_quotes(model)));
  const std::vector<double> size = yaml_numbers(camera, "resolution", 2, source);
  const std::vector<double> k = yaml_numbers(camera, "intrinsics", 4, source);
  CameraCalibration calibration;
  calibration.pinhole = {static_cast<int>(std::clamp(size[0], -1.0, 1e9)),
                         static_cast<int>(std::clamp(size[1], -1.0, 1e9)),
                         k[0],
                         k[1],
                         k[2],
                         k[3]};
  if (!camera["distortion_model"]) return calibration;
  calibration.distortion_model =
      distortion_model_of(yaml_text(camera, "distortion_model", source), source);
  if (calibration.distortion_model != DistortionModel::none)
    calibration.distortion = yaml_numbers(camera, coefficients_key, source);
  return calibration;
}

std::vector<double> yaml_matrix(const YAML::Node& map, const std::string& key, std::size_t count,
                                const std::string& source) {
  const YAML::Node value = yaml_value(map, key, source);
  return value.IsMap() ? yaml_numbers(value, "data", count, source)
                       : yaml_numbers(map, key, count, source);
}

Eigen::Quaterniond yaml_rotation(const YAML::Node& map, const std::string& key,
                                 const std::string& source) {
  const std::vector<double> m = yaml_matrix(map, key, 9, source);
  return rotation_of(Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(m.data()), key,
                     source);
}

SE3 yaml_rigid_motion(const YAML::Node& map, const std::string& key, const std::string& source) {
  const std::vector<double> m = yaml_matrix(map, key, 16, source);
  const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> T(m.data());
  if (!T.row(3).isApprox(Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0)))
    throw Error(fmt::format("{}: the last row of '{}' is not 0 0 0 1", source, key));
  return {rotation_of(T.topLeftCorner<3, 3>(), key, source), T.topRightCorner<3, 1>()};
}

bool is_rectified(const StereoRig& rig) {
  const PinholeCamera &l = rig.left.pinhole, &r = rig.right.pinhole;
  const SE3& T = rig.T_right_left;
  return has_no_distortion(rig.left) && has_no_distortion(rig.right) && l.fx_px == r.fx_px &&
         l.fy_px == r.fy_px && l.cx_px == r.cx_px && l.cy_px == r.cy_px &&
         rotation_angle_rad(T) < kRectifiedTolerance_rad &&
         T.translation.tail<2>().norm() < kRectifiedTolerance_m;
}

StereoRig read_plain_calibration(const std::filesystem::path& path) {
  const YAML::Node calibration = load_yaml(path);
  const std::string source = path.string();
  const auto number = [&](const char* key) { return yaml_number(calibration, key, source); };
  StereoRig rig;
  rig.left.pinhole = {yaml_integer(calibration, "width", source),
                      yaml_integer(calibration, "height", source),
                      number("fx"),
                      number("fy"),
                      number("cx"),
                      number("cy")};
  rig.right = rig.left;
  rig.T_right_left.translation = {-number("baseline"), 0.0, 0.0};
  if (calibration["doffs"]) rig.right.pinhole.cx_px += number("doffs");
  rig.is_rectified = is_rectified(rig);
  return rig;
}

KittiCalibration read_kitti_calibration(const std::filesystem::path& path, int left, int right,
                                        cv::Size image_size) {
  const std::string source = path.string();
  const std::map<std::string, Projection> projections = read_projections(path);
  const Projection& P_left = find_projection(projections, left, source);
  const Projection& P_right = find_projection(projections, right, source);
  const double baseline_m = (P_left[3] - P_right[3]) / P_left[0];
  if (!(baseline_m > 0.0))
    throw Error(fmt::format(
        "{0}: baseline is {1:.6g} m, it must be positive; baseline = (P{2}[3] - P{3}[3]) / P{2}[0] "
        "with P{2} = [{4}] and P{3} = [{5}]",
        source, baseline_m, left, right, fmt::join(P_left, " "), fmt::join(P_right, " ")));
  KittiCalibration calibration;
  calibration.rig.left.pinhole = pinhole_of(P_left, image_size);
  calibration.rig.right.pinhole = pinhole_of(P_right, image_size);
  calibration.rig.T_right_left.translation = {-baseline_m, 0.0, 0.0};
  calibration.rig.is_rectified = is_rectified(calibration.rig);
  calibration.T_cam0_left.translation = -offset_from_camera_0(P_left);
  return calibration;
}

AslCamera read_asl_camera(const std::filesystem::path& sensor_yaml) {
  const YAML::Node sensor = load_yaml(sensor_yaml);
  const std::string source = sensor_yaml.string();
  return {pinhole_calibration(sensor, "distortion_coefficients", source),
          yaml_rigid_motion(sensor, "T_BS", source)};
}

StereoRig stereo_rig(const AslCamera& left, const AslCamera& right) {
  StereoRig rig{left.calibration, right.calibration,
                inverse(right.T_body_camera) * left.T_body_camera};
  rig.is_rectified = is_rectified(rig);
  return rig;
}

}  // namespace stereovox
