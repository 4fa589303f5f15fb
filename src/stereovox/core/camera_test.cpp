#include "stereovox/core/camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "stereovox/core/error.h"

namespace stereovox {
namespace {

const RectifiedCamera kCamera{{640, 480, 525.0, 525.0, 320.0, 240.0}, 0.12};

StereoRig usable_rig() {
  StereoRig rig;
  rig.left.pinhole = rig.right.pinhole = kCamera.pinhole;
  rig.T_right_left.translation = {-0.12, 0.0, 0.0};
  return rig;
}

std::string complaint_about(const StereoRig& rig) {
  try {
    validate(rig, "calib.yaml");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Camera, TriangulatesThePaperExample) {
  const Eigen::Vector3d X = triangulate(kCamera, 420.0, 190.0, 21.0);
  EXPECT_NEAR(X.x(), 0.571429, 1e-6);
  EXPECT_NEAR(X.y(), -0.285714, 1e-6);
  EXPECT_NEAR(X.z(), 3.0, 1e-12);
  EXPECT_NEAR((project(kCamera.pinhole, X) - Eigen::Vector2d(420.0, 190.0)).norm(), 0.0, 1e-12);
}

TEST(Camera, CovarianceOfAPointIsTheFirstOrderSpreadOfItsTriangulation) {
  const double u = 420.0, v = 190.0, d = 21.0, step = 1e-5, sp = 0.4, sm = 0.7;
  Eigen::Matrix3d J;
  J.col(0) = (triangulate(kCamera, u + step, v, d) - triangulate(kCamera, u - step, v, d));
  J.col(1) = (triangulate(kCamera, u, v + step, d) - triangulate(kCamera, u, v - step, d));
  J.col(2) = (triangulate(kCamera, u, v, d + step) - triangulate(kCamera, u, v, d - step));
  J /= 2.0 * step;
  const Eigen::Vector3d variances(sp * sp, sp * sp, sm * sm);
  const Eigen::Matrix3d numeric = J * variances.asDiagonal() * J.transpose();
  EXPECT_LT((triangulation_covariance(kCamera, u, v, d, sp, sm) - numeric).norm(), 1e-9);
}

TEST(Camera, AUsableRigPassesAndAnOddBaselineIsRemarked) {
  EXPECT_EQ(complaint_about(usable_rig()), "");
  EXPECT_TRUE(oddities(usable_rig()).empty());
  StereoRig wide = usable_rig();
  wide.T_right_left.translation.x() = -4.0;
  EXPECT_EQ(oddities(wide).size(), 1U);
}

TEST(Camera, AnUnusableRigIsRefusedWithTheNumber) {
  using testing::HasSubstr;
  StereoRig rig = usable_rig();
  rig.left.pinhole.fx_px = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(complaint_about(rig), "calib.yaml: left camera: fx is nan");

  rig = usable_rig();
  rig.T_right_left.translation.setZero();
  EXPECT_EQ(complaint_about(rig), "calib.yaml: baseline is 0 m");

  rig = usable_rig();
  rig.T_right_left.translation.x() = 0.12;
  EXPECT_THAT(complaint_about(rig), HasSubstr("right camera is 0.12 m to the left"));

  rig = usable_rig();
  rig.T_right_left.translation.x() = -120.0;
  EXPECT_THAT(complaint_about(rig), HasSubstr("baseline is 120 m, outside [0.005, 10] m"));

  rig = usable_rig();
  rig.right.distortion_model = DistortionModel::radial_tangential;
  rig.right.distortion = {0.1, 0.2, 0.3};
  EXPECT_THAT(complaint_about(rig), HasSubstr("right camera: has 3 distortion coefficients"));

  rig = usable_rig();
  rig.right.pinhole.width = 1280;
  EXPECT_THAT(complaint_about(rig),
              HasSubstr("left images are 640 x 480, right images 1280 x 480"));
}

}  // namespace
}  // namespace stereovox
