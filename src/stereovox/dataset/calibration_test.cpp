#include "stereovox/dataset/calibration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "stereovox/core/error.h"
#include "stereovox/dataset/small_data_set.h"
#include "stereovox/io/temporary_folder.h"

namespace stereovox {
namespace {

using testing::HasSubstr;

constexpr const char* kKittiCalibration =
    "P0: 700 0 600 0 0 710 180 0 0 0 1 0\n"
    "P1: 700 0 600 -378 0 710 180 0 0 0 1 0\n"
    "P2: 700 0 600 42 0 710 180 1.42 0 0 1 0.01\n"
    "P3: 700 0 600 -329 0 710 180 0.71 0 0 1 0.02\n"
    "Tr: 1 0 0 0 0 1 0 0 0 0 1 0\n";
constexpr const char* kSensor =
    "%YAML:1.0\nT_BS:\n  cols: 4\n  rows: 4\n  data: [0, -1, 0, 0.1, 1, 0, 0, 0.2, 0, 0, 1, 0.3,"
    " 0, 0, 0, 1]\nresolution: [752, 480]\ncamera_model: pinhole\nintrinsics: [458, 457, 367, "
    "248]\n"
    "distortion_model: radial-tangential\ndistortion_coefficients: [-0.28, 0.07, 0.0002, "
    "0.00001]\n";

std::string replaced(std::string text, const std::string& old_part, const std::string& new_part) {
  return text.replace(text.find(old_part), old_part.size(), new_part);
}

// What `read` says about a file with this text.
template <class Read>
std::string complaint(const char* name, const std::string& text, Read read) {
  const TemporaryFolder folder;
  const auto path = folder.write(name, text);
  try {
    read(path);
  } catch (const Error& error) {
    return std::string(error.what()).substr(folder.path().string().size() + 1);
  }
  return "";
}

std::string plain_complaint(const std::string& old_part, const std::string& new_part) {
  return complaint("calib.yaml", replaced(kSmallCalibration, old_part, new_part),
                   [](const auto& path) { validate(read_plain_calibration(path), path.string()); });
}

std::string kitti_complaint(const std::string& text) {
  return complaint("calib.txt", text, [](const auto& path) {
    validate(read_kitti_calibration(path, 0, 1, {1226, 370}).rig, path.string());
  });
}

std::string asl_complaint(const std::string& old_part, const std::string& new_part) {
  return complaint("sensor.yaml", replaced(kSensor, old_part, new_part), [](const auto& path) {
    AslCamera left = read_asl_camera(path), right = left;
    right.T_body_camera = left.T_body_camera * SE3{Eigen::Quaterniond::Identity(), {0.1, 0, 0}};
    validate(stereo_rig(left, right), path.string());
  });
}

TEST(PlainCalibration, IsARectifiedRig) {
  const TemporaryFolder folder;
  const StereoRig rig = read_plain_calibration(folder.write("calib.yaml", kSmallCalibration));
  EXPECT_TRUE(rig.is_rectified);
  EXPECT_EQ(rig.right.pinhole.cx_px, 15.5);
  EXPECT_EQ(rig.T_right_left.translation, Eigen::Vector3d(-0.12, 0.0, 0.0));
}

TEST(PlainCalibration, OfTwoPrincipalPointsIsNotRectified) {
  const TemporaryFolder folder;
  const StereoRig rig = read_plain_calibration(
      folder.write("calib.yaml", std::string(kSmallCalibration) + "doffs: 2.5\n"));
  EXPECT_FALSE(rig.is_rectified);
  EXPECT_EQ(rig.right.pinhole.cx_px, 18.0);
}

TEST(PlainCalibration, ThatCannotBeUsedIsRefusedByTheNameOfTheKey) {
  EXPECT_EQ(plain_complaint("fx: 30.0\n", ""), "calib.yaml: 'fx' is missing");
  EXPECT_EQ(plain_complaint("fx: 30.0", "fx: abc"),
            "calib.yaml:3: 'fx' is 'abc', not a finite number");
  EXPECT_EQ(plain_complaint("cy: 9.5", "cy: nan"),
            "calib.yaml:6: 'cy' is 'nan', not a finite number");
  EXPECT_EQ(plain_complaint("cy: 9.5", "cy: .inf"),
            "calib.yaml:6: 'cy' is '.inf', not a finite number");
  EXPECT_EQ(plain_complaint("0.12", "0"), "calib.yaml: baseline is 0 m");
  EXPECT_THAT(plain_complaint("0.12", "-0.12"),
              HasSubstr("calib.yaml: right camera is 0.12 m to the left"));
  EXPECT_THAT(plain_complaint("0.12", "120"), HasSubstr("is it in millimetres?"));
  EXPECT_EQ(plain_complaint("width: 32", "width: 32.5"),
            "calib.yaml:1: 'width' is '32.5', not a whole number");
}

TEST(KittiCalibration, OfTheGreyCamerasHasItsBaselineInP1) {
  const TemporaryFolder folder;
  const auto [rig, T_cam0_left] =
      read_kitti_calibration(folder.write("calib.txt", kKittiCalibration), 0, 1, {1226, 370});
  EXPECT_NEAR(rig.baseline_m(), 378.0 / 700.0, 1e-12);
  EXPECT_TRUE(rig.is_rectified);
  EXPECT_EQ(rig.left.pinhole.fy_px, 710.0);
  EXPECT_EQ(rig.left.pinhole.width, 1226);
  EXPECT_EQ(T_cam0_left.translation.norm(), 0.0);
}

TEST(KittiCalibration, OfTheColourCamerasIsRelativeToCamera0) {
  const TemporaryFolder folder;
  const auto [rig, T_cam0_left] =
      read_kitti_calibration(folder.write("calib.txt", kKittiCalibration), 2, 3, {1226, 370});
  EXPECT_NEAR(rig.baseline_m(), (42.0 + 329.0) / 700.0, 1e-12);
  // A point of camera 0, projected by P2 directly and by way of the left camera.
  const Eigen::Vector3d p_cam0(0.3, -0.2, 4.0);
  const double w = 4.0 + 0.01;
  const Eigen::Vector2d direct((700 * 0.3 + 600 * 4.0 + 42) / w,
                               (710 * -0.2 + 180 * 4.0 + 1.42) / w);
  EXPECT_NEAR((project(rig.left.pinhole, inverse(T_cam0_left) * p_cam0) - direct).norm(), 0.0,
              1e-9);
}

TEST(KittiCalibration, WithAWrongBaselineIsRefusedWithItsRowsAndTheRule) {
  EXPECT_EQ(
      kitti_complaint(replaced(kKittiCalibration, "-378", "378")),
      "calib.txt: baseline is -0.54 m, it must be positive; baseline = (P0[3] - P1[3]) / P0[0] "
      "with P0 = [700 0 600 0 0 710 180 0 0 0 1 0] and P1 = [700 0 600 378 0 710 180 0 0 0 1 0]");
  EXPECT_THAT(kitti_complaint(replaced(kKittiCalibration, "-378", "0")),
              HasSubstr("calib.txt: baseline is 0 m, it must be positive"));
  EXPECT_EQ(kitti_complaint("P0: 1 2 3\n"), "calib.txt:1: has 4 fields, 13 are needed");
  EXPECT_EQ(kitti_complaint(replaced(kKittiCalibration, "P1:", "P7:")),
            "calib.txt: 'P1:' is missing");
  EXPECT_EQ(kitti_complaint(replaced(kKittiCalibration, "710", "inf")),
            "calib.txt:1: field 7 is 'inf', not a finite number");
}

TEST(AslCalibration, HoldsThePinholeTheDistortionAndThePose) {
  const TemporaryFolder folder;
  const AslCamera camera = read_asl_camera(folder.write("sensor.yaml", kSensor));
  EXPECT_EQ(camera.calibration.pinhole.cy_px, 248.0);
  EXPECT_EQ(camera.calibration.distortion_model, DistortionModel::radial_tangential);
  EXPECT_THAT(camera.calibration.distortion, testing::ElementsAre(-0.28, 0.07, 0.0002, 0.00001));
  EXPECT_LT(
      (camera.T_body_camera * Eigen::Vector3d(1, 2, 3) - Eigen::Vector3d(-1.9, 1.2, 3.3)).norm(),
      1e-12);
}

TEST(AslCalibration, MayGiveItsPoseAsRows) {
  const TemporaryFolder folder;
  std::string text = kSensor;
  const std::size_t begin = text.find("T_BS"), end = text.find("resolution");
  text.replace(begin, end - begin,
               "T_BS: [[0, -1, 0, 0.1], [1, 0, 0, 0.2], [0, 0, 1, 0.3], [0, 0, 0, 1]]\n");
  const AslCamera camera = read_asl_camera(folder.write("sensor.yaml", text));
  EXPECT_EQ(camera.T_body_camera.translation, Eigen::Vector3d(0.1, 0.2, 0.3));
}

TEST(AslCalibration, OfAlignedCamerasWithoutDistortionIsRectified) {
  const TemporaryFolder folder;
  std::string text = kSensor;
  text = text.substr(0, text.find("distortion_model"));
  const AslCamera left = read_asl_camera(folder.write("sensor.yaml", text));
  AslCamera right = left;
  right.T_body_camera = left.T_body_camera * SE3{Eigen::Quaterniond::Identity(), {0.11, 0, 0}};
  EXPECT_TRUE(stereo_rig(left, right).is_rectified);
  right.T_body_camera.rotation =
      left.T_body_camera.rotation * Eigen::AngleAxisd(0.01, Eigen::Vector3d::UnitX());
  EXPECT_FALSE(stereo_rig(left, right).is_rectified);
}

TEST(AslCalibration, ThatCannotBeUsedIsRefused) {
  EXPECT_EQ(asl_complaint("pinhole", "pinhole"), "");
  EXPECT_THAT(asl_complaint("[0, -1, 0, 0.1, 1", "[0, -1, 0, 0.1, -1"),
              HasSubstr("sensor.yaml: the rotation in 'T_BS' is none"));
  EXPECT_THAT(asl_complaint("[0, -1, 0, 0.1, 1", "[0, -1, 0, 0.1, 1.1"),
              HasSubstr("'T_BS' is none (R R^T differs from I by 0.21)"));
  EXPECT_EQ(asl_complaint("0, 0, 0, 1]", "0, 0, 1]"),
            "sensor.yaml:5: 'data' has 15 numbers, 16 are needed");
  EXPECT_THAT(asl_complaint(", 0.00001]", "]"),
              HasSubstr("left camera: has 3 distortion coefficients"));
  EXPECT_THAT(asl_complaint(", 0.00001]", ", 0, 1, 2]"),
              HasSubstr("has 6 distortion coefficients"));
  EXPECT_EQ(asl_complaint("pinhole", "omni"), "sensor.yaml: camera model 'omni' is not 'pinhole'");
  EXPECT_THAT(asl_complaint("radial-tangential", "fov"),
              HasSubstr("distortion model 'fov' is none of"));
  EXPECT_EQ(asl_complaint("[458,", "[nan,"),
            "sensor.yaml:8: 'intrinsics' is 'nan', not a finite number");
}

}  // namespace
}  // namespace stereovox
