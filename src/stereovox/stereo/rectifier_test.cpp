#include "stereovox/stereo/rectifier.h"

#include <gtest/gtest.h>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace stereovox {
namespace {

CameraCalibration distorted_camera(double cx_px) {
  return {{752, 480, 458.0, 457.0, cx_px, 248.0},
          DistortionModel::radial_tangential,
          {-0.283, 0.074, 0.0002, 0.00002}};
}

// Turned and shifted as real rigs are: a degree here, a millimetre there.
StereoRig crooked_rig() {
  StereoRig rig{distorted_camera(367.0), distorted_camera(379.0), {}, false};
  Vector6d twist;
  twist << -0.110, 0.001, -0.002, 0.01, -0.015, 0.02;
  rig.T_right_left = exp(twist);
  return rig;
}

cv::Point2d seen_by(const CameraCalibration& camera, const Eigen::Vector3d& p) {
  const PinholeCamera& c = camera.pinhole;
  const cv::Mat1d K = (cv::Mat1d(3, 3) << c.fx_px, 0, c.cx_px, 0, c.fy_px, c.cy_px, 0, 0, 1);
  std::vector<cv::Point2d> pixel;
  cv::projectPoints(std::vector<cv::Point3d>{{p.x(), p.y(), p.z()}}, cv::Vec3d(), cv::Vec3d(), K,
                    camera.distortion, pixel);
  return pixel.front();
}

// A soft dot, so that its place can be measured below a pixel.
GrayImage dot_at(cv::Point2d pixel) {
  GrayImage image{cv::Mat1b(480, 752, static_cast<uchar>(0))};
  for (int v = 0; v < 480; ++v)
    for (int u = 0; u < 752; ++u) {
      const double r2 = (u - pixel.x) * (u - pixel.x) + (v - pixel.y) * (v - pixel.y);
      image.pixels(v, u) = cv::saturate_cast<uchar>(250.0 * std::exp(-r2 / 18.0));
    }
  return image;
}

cv::Point2d centre_of(const GrayImage& image) {
  const cv::Moments m = cv::moments(image.pixels);
  return {m.m10 / m.m00, m.m01 / m.m00};
}

TEST(Rectifier, PutsAPointIntoOneRowAtTheDisparityOfItsDepth) {
  const StereoRig rig = crooked_rig();
  const Rectifier rectifier(rig, {});
  for (const Eigen::Vector3d& p_left :
       {Eigen::Vector3d(0.3, -0.2, 3.0), {-0.8, 0.5, 4.0}, {0.1, 0.1, 1.5}}) {
    const StereoFrame frame{0, 0, "", dot_at(seen_by(rig.left, p_left)),
                            dot_at(seen_by(rig.right, rig.T_right_left * p_left))};
    const RectifiedPair pair = rectifier.rectify(frame);
    const cv::Point2d left = centre_of(pair.left), right = centre_of(pair.right);
    const Eigen::Vector3d p = inverse(rectifier.T_left_rectified()) * p_left;
    const Eigen::Vector2d expected = project(rectifier.camera().pinhole, p);
    EXPECT_NEAR(left.x, expected.x(), 0.1);
    EXPECT_NEAR(left.y, expected.y(), 0.1);
    EXPECT_NEAR(right.y, left.y, 0.1);
    EXPECT_NEAR(left.x - right.x, rectifier.camera().disparity_px(p.z()), 0.15);
  }
  EXPECT_NEAR(rectifier.camera().baseline_m, rig.baseline_m(), 1e-9);
}

TEST(Rectifier, MarksPixelsThatWereNotRecorded) {
  RectificationParams keep_everything;
  keep_everything.alpha = 1.0;
  const StereoFrame frame{0, 0, "", {cv::Mat1b(480, 752, 200)}, {cv::Mat1b(480, 752, 200)}};
  const RectifiedPair pair = Rectifier(crooked_rig(), keep_everything).rectify(frame);
  const int recorded = cv::countNonZero(pair.valid_left);
  EXPECT_GT(recorded, 100000);
  EXPECT_LT(recorded, 480 * 752 * 9 / 10);
  EXPECT_EQ(cv::countNonZero((pair.left.pixels != 200) & pair.valid_left), 0);
}

TEST(Rectifier, PassesRectifiedImagesThrough) {
  StereoRig rig;
  rig.left.pinhole = rig.right.pinhole = {64, 48, 50.0, 50.0, 31.0, 23.0};
  rig.T_right_left.translation = {-0.1, 0.0, 0.0};
  rig.is_rectified = true;
  const StereoFrame frame{5, 0, "", {cv::Mat1b(48, 64, 7)}, {cv::Mat1b(48, 64, 9)}};
  const Rectifier rectifier(rig, {});
  const RectifiedPair pair = rectifier.rectify(frame);
  EXPECT_EQ(pair.left.pixels.data, frame.left.pixels.data);
  EXPECT_EQ(pair.stamp_ns, 5);
  EXPECT_TRUE(pair.valid_left.empty());
  EXPECT_EQ(rectifier.camera().baseline_m, 0.1);
}

}  // namespace
}  // namespace stereovox
