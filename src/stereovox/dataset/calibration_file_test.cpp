#include "stereovox/dataset/calibration_file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stereovox/core/error.h"
#include "stereovox/dataset/small_data_set.h"
#include "stereovox/io/temporary_folder.h"

namespace stereovox {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

// One rig for all forms: cameras that are turned against each other and see through lenses.
const Eigen::Quaterniond kTurnOfLeft(Eigen::AngleAxisd(0.01,
                                                       Eigen::Vector3d(1, 2, -1).normalized()));
const Eigen::Quaterniond kTurnOfRight(Eigen::AngleAxisd(-0.02,
                                                        Eigen::Vector3d(0, 1, 3).normalized()));
constexpr double kBaseline_m = 0.11;

StereoRig expected_rig() {
  StereoRig rig;
  rig.left.pinhole = {640, 480, 450, 451, 321, 243};
  rig.left.distortion_model = DistortionModel::radial_tangential;
  rig.left.distortion = {-0.28, 0.07, 0.0002, 0.00001};
  rig.right = rig.left;
  rig.right.pinhole.cx_px = 330;
  rig.T_right_left =
      SE3{kTurnOfRight.inverse(), Eigen::Vector3d::Zero()} * SE3{kTurnOfLeft, {-kBaseline_m, 0, 0}};
  return rig;
}

std::string rows(const Eigen::MatrixXd& matrix) {
  std::string text;
  for (int i = 0; i < matrix.rows(); ++i)
    for (int j = 0; j < matrix.cols(); ++j)
      text += fmt::format("{}{:.17g}", text.empty() ? "" : ", ", matrix(i, j));
  return "[" + text + "]";
}

std::string opencv_matrix(const char* key, const Eigen::MatrixXd& matrix) {
  return fmt::format("{}: !!opencv-matrix\n  rows: {}\n  cols: {}\n  dt: d\n  data: {}\n", key,
                     matrix.rows(), matrix.cols(), rows(matrix));
}

Eigen::MatrixXd intrinsic_matrix(const CameraCalibration& camera) {
  const PinholeCamera& c = camera.pinhole;
  return Eigen::Matrix3d{{c.fx_px, 0, c.cx_px}, {0, c.fy_px, c.cy_px}, {0, 0, 1}};
}

Eigen::MatrixXd coefficients(const CameraCalibration& camera, int count) {
  Eigen::MatrixXd D = Eigen::MatrixXd::Zero(1, count);
  for (std::size_t i = 0; i < camera.distortion.size(); ++i)
    D(0, static_cast<int>(i)) = camera.distortion[i];
  return D;
}

std::string kalibr_camera(const char* name, const CameraCalibration& camera) {
  const PinholeCamera& c = camera.pinhole;
  return fmt::format(
      "{}:\n  camera_model: pinhole\n  intrinsics: [{}, {}, {}, {}]\n  distortion_model: radtan\n"
      "  distortion_coeffs: {}\n  resolution: [{}, {}]\n  rostopic: /{}/image_raw\n",
      name, c.fx_px, c.fy_px, c.cx_px, c.cy_px, rows(coefficients(camera, 4)), c.width, c.height,
      name);
}

std::string kalibr_chain() {
  const StereoRig rig = expected_rig();
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  T.topLeftCorner<3, 3>() = rig.T_right_left.rotation.toRotationMatrix();
  T.topRightCorner<3, 1>() = rig.T_right_left.translation;
  std::string nested;
  for (int i = 0; i < 4; ++i) nested += "  - " + rows(T.row(i)) + "\n";
  return kalibr_camera("cam0", rig.left) + kalibr_camera("cam1", rig.right) + "  T_cn_cnm1:\n" +
         nested;
}

std::string camera_info(const CameraCalibration& camera, const Eigen::Quaterniond& turn,
                        double offset) {
  Eigen::MatrixXd P = Eigen::MatrixXd::Zero(3, 4);
  P(0, 0) = P(1, 1) = 440, P(0, 2) = 320, P(1, 2) = 240, P(2, 2) = 1, P(0, 3) = offset;
  const auto matrix = [](const char* key, const Eigen::MatrixXd& m) {
    return fmt::format("{}:\n  rows: {}\n  cols: {}\n  data: {}\n", key, m.rows(), m.cols(),
                       rows(m));
  };
  return fmt::format("image_width: {}\nimage_height: {}\ncamera_name: narrow_stereo\n",
                     camera.pinhole.width, camera.pinhole.height) +
         matrix("camera_matrix", intrinsic_matrix(camera)) + "distortion_model: plumb_bob\n" +
         matrix("distortion_coefficients", coefficients(camera, 5)) +
         matrix("rectification_matrix", turn.toRotationMatrix()) + matrix("projection_matrix", P);
}

std::string opencv_intrinsics(int count = 5) {
  const StereoRig rig = expected_rig();
  return "%YAML:1.0\n---\n" + opencv_matrix("M1", intrinsic_matrix(rig.left)) +
         opencv_matrix("D1", coefficients(rig.left, count)) +
         opencv_matrix("M2", intrinsic_matrix(rig.right)) +
         opencv_matrix("D2", coefficients(rig.right, count));
}

std::string opencv_extrinsics() {
  const SE3 T = expected_rig().T_right_left;
  return "%YAML:1.0\n---\n" + opencv_matrix("R", T.rotation.toRotationMatrix()) +
         opencv_matrix("T", T.translation);
}

StereoRig read(const fs::path& path) {
  StereoRig rig = read_calibration(path, [] { return cv::Size(640, 480); });
  validate(rig, path.string());
  return rig;
}

std::string refusal(const fs::path& path) {
  try {
    read(path);
  } catch (const Error& error) {
    return std::string(error.what()).substr(path.parent_path().string().size() + 1);
  }
  return "";
}

void expect_the_rig(const StereoRig& rig) {
  const StereoRig expected = expected_rig();
  EXPECT_FALSE(rig.is_rectified);
  for (const auto& [found, camera] :
       {std::pair{rig.left, expected.left}, std::pair{rig.right, expected.right}}) {
    EXPECT_EQ(found.pinhole.width, camera.pinhole.width);
    EXPECT_EQ(found.pinhole.height, camera.pinhole.height);
    EXPECT_EQ(found.pinhole.fy_px, camera.pinhole.fy_px);
    EXPECT_EQ(found.pinhole.cx_px, camera.pinhole.cx_px);
    EXPECT_EQ(found.distortion_model, camera.distortion_model);
    ASSERT_GE(found.distortion.size(), 4U);
    for (std::size_t i = 0; i < found.distortion.size(); ++i)
      EXPECT_EQ(found.distortion[i], i < 4 ? camera.distortion[i] : 0.0);
  }
  const SE3 difference = inverse(rig.T_right_left) * expected.T_right_left;
  EXPECT_LT(rotation_angle_rad(difference), 1e-9);
  EXPECT_LT(difference.translation.norm(), 1e-9);
}

TEST(CalibrationFile, OfKalibr) {
  const TemporaryFolder folder;
  expect_the_rig(read(folder.write("camchain-april.yaml", kalibr_chain())));
  folder.write("camchain.yaml", kalibr_chain());
  expect_the_rig(read(folder.path()));
}

TEST(CalibrationFile, OfRosIsEitherFileOrTheirFolder) {
  const TemporaryFolder folder;
  const StereoRig rig = expected_rig();
  const fs::path left = folder.write("left.yaml", camera_info(rig.left, kTurnOfLeft, 0.0));
  const fs::path right =
      folder.write("right.yaml", camera_info(rig.right, kTurnOfRight, -440 * kBaseline_m));
  for (const fs::path& path : {left, right, folder.path()}) expect_the_rig(read(path));
}

TEST(CalibrationFile, OfRosIsRefusedWhenItsBaselineIsNotNegative) {
  const TemporaryFolder folder;
  const StereoRig rig = expected_rig();
  const fs::path left = folder.write("left.yaml", camera_info(rig.left, kTurnOfLeft, 0.0));
  folder.write("right.yaml", camera_info(rig.right, kTurnOfRight, 48.4));
  EXPECT_EQ(refusal(left),
            "right.yaml: the fourth entry of 'projection_matrix' is 48.4; that of the right camera "
            "is -fx baseline, so negative. Are left and right exchanged?");
  const fs::path one = folder.write("camera.yaml", camera_info(rig.left, kTurnOfLeft, 0.0));
  EXPECT_THAT(refusal(one), HasSubstr("camera.yaml: is a camera_info of one camera"));
}

TEST(CalibrationFile, OfOpenCvIsEitherFileOrBothInOne) {
  const TemporaryFolder folder;
  const fs::path intrinsics = folder.write("intrinsics.yml", opencv_intrinsics());
  const fs::path extrinsics = folder.write("extrinsics.yml", opencv_extrinsics());
  for (const fs::path& path : {intrinsics, extrinsics, folder.path()}) expect_the_rig(read(path));
  std::string both = opencv_intrinsics(14) + opencv_extrinsics().substr(14);
  for (const auto& [from, to] : {std::pair{"M1", "K1"}, std::pair{"M2", "K2"}})
    both.replace(both.find(from), 2, to);
  expect_the_rig(read(folder.write("stereo.yaml", both)));
}

TEST(CalibrationFile, OfOpenCvWithoutItsOtherFileIsRefused) {
  const TemporaryFolder folder;
  EXPECT_EQ(refusal(folder.write("intrinsics.yml", opencv_intrinsics())),
            "intrinsics.yml: holds the intrinsics only; the extrinsics are looked for in a file "
            "beside it whose name says extrinsics instead of intrinsics");
}

TEST(CalibrationFile, OfAslIsASensorFileOrAFolder) {
  const TemporaryFolder folder;
  const StereoRig rig = expected_rig();
  const auto sensor = [](const CameraCalibration& camera, const SE3& T_body_camera) {
    Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
    T.topLeftCorner<3, 3>() = T_body_camera.rotation.toRotationMatrix();
    T.topRightCorner<3, 1>() = T_body_camera.translation;
    const PinholeCamera& c = camera.pinhole;
    return fmt::format(
        "T_BS:\n  cols: 4\n  rows: 4\n  data: {}\nresolution: [{}, {}]\ncamera_model: pinhole\n"
        "intrinsics: [{}, {}, {}, {}]\ndistortion_model: radial-tangential\n"
        "distortion_coefficients: {}\n",
        rows(T), c.width, c.height, c.fx_px, c.fy_px, c.cx_px, c.cy_px,
        rows(coefficients(camera, 4)));
  };
  const SE3 T_body_left{kTurnOfLeft, {0.1, 0.2, 0.3}};
  fs::create_directories(folder.path() / "cam0");
  fs::create_directories(folder.path() / "cam1");
  const fs::path left = folder.write("cam0/sensor.yaml", sensor(rig.left, T_body_left));
  folder.write("cam1/sensor.yaml", sensor(rig.right, T_body_left * inverse(rig.T_right_left)));
  for (const fs::path& path : {left, folder.path()}) expect_the_rig(read(path));
}

TEST(CalibrationFile, OfKittiTakesTheSizeOfTheImages) {
  const TemporaryFolder folder;
  const fs::path path = folder.write("calib.txt",
                                     "P0: 700 0 320 0 0 700 240 0 0 0 1 0\n"
                                     "P1: 700 0 320 -350 0 700 240 0 0 0 1 0\n");
  for (const fs::path& place : {path, folder.path()}) {
    const StereoRig rig = read(place);
    EXPECT_EQ(rig.left.pinhole.width, 640);
    EXPECT_EQ(rig.baseline_m(), 0.5);
    EXPECT_TRUE(rig.is_rectified);
  }
}

TEST(CalibrationFile, OfThePlainFormIsWhatIsLeft) {
  const TemporaryFolder folder;
  EXPECT_TRUE(read(folder.write("calib.yaml", kSmallCalibration)).is_rectified);
  EXPECT_EQ(refusal(folder.write("other.yaml", "a: 1\n")), "other.yaml: 'width' is missing");
  EXPECT_THAT(refusal(folder.write("list.yaml", "- 1\n")),
              HasSubstr("list.yaml: is no calibration"));
}

TEST(CalibrationFile, ThatIsNotThereIsNotAskedForItsImages) {
  const TemporaryFolder folder;
  EXPECT_EQ(refusal(folder.path() / "calib.txt"),
            "calib.txt: cannot be opened (No such file or directory)");
}

TEST(CalibrationFile, OfAFolderWithoutOneSaysWhatIsLookedFor) {
  const TemporaryFolder folder;
  EXPECT_THAT(refusal(folder.path()), HasSubstr("holds no calibration; looked for calib.yaml"));
}

}  // namespace
}  // namespace stereovox
