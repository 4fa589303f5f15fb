#include "stereovox/stereo/rectifier.h"

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace stereovox {
namespace {

cv::Mat1d camera_matrix(const PinholeCamera& c) {
  return (cv::Mat1d(3, 3) << c.fx_px, 0, c.cx_px, 0, c.fy_px, c.cy_px, 0, 0, 1);
}

cv::Mat1d coefficients(const CameraCalibration& camera) {
  constexpr int kFewest = 4;  // that OpenCV takes
  if (camera.distortion.empty()) return cv::Mat1d::zeros(1, kFewest);
  return cv::Mat1d(camera.distortion, true).reshape(1, 1);
}

cv::Mat1d rotation_matrix(const SE3& T) {
  const Eigen::Matrix3d R = T.rotation.toRotationMatrix();
  cv::Mat1d m(3, 3);
  for (int i = 0; i < 9; ++i) m(i / 3, i % 3) = R(i / 3, i % 3);
  return m;
}

SE3 pure_rotation(const cv::Mat1d& m) {
  Eigen::Matrix3d R;
  for (int i = 0; i < 9; ++i) R(i / 3, i % 3) = m(i / 3, i % 3);
  return {Eigen::Quaterniond(R).normalized(), Eigen::Vector3d::Zero()};
}

struct RectifyingTransforms {
  cv::Mat1d R_left, R_right, P_left, P_right;
};

bool is_fisheye(const StereoRig& rig) {
  return rig.left.distortion_model == DistortionModel::equidistant;
}

// Bouguet's method: both cameras are turned half-way towards each other, then along the baseline.
RectifyingTransforms rectifying_transforms(const StereoRig& rig, double alpha) {
  const cv::Mat1d K_left = camera_matrix(rig.left.pinhole);
  const cv::Mat1d K_right = camera_matrix(rig.right.pinhole);
  const cv::Mat1d D_left = coefficients(rig.left), D_right = coefficients(rig.right);
  const Eigen::Vector3d t = rig.T_right_left.translation;
  const cv::Mat1d R = rotation_matrix(rig.T_right_left);
  const cv::Mat1d T = (cv::Mat1d(3, 1) << t.x(), t.y(), t.z());
  const cv::Size size(rig.left.pinhole.width, rig.left.pinhole.height);
  RectifyingTransforms out;
  cv::Mat1d Q;
  if (is_fisheye(rig)) {
    cv::fisheye::stereoRectify(K_left, D_left, K_right, D_right, size, R, T, out.R_left,
                               out.R_right, out.P_left, out.P_right, Q, cv::CALIB_ZERO_DISPARITY,
                               size, alpha);
  } else {
    cv::stereoRectify(K_left, D_left, K_right, D_right, size, R, T, out.R_left, out.R_right,
                      out.P_left, out.P_right, Q, cv::CALIB_ZERO_DISPARITY, alpha, size);
  }
  return out;
}

GrayImage warped(const GrayImage& image, const cv::Mat& map, const cv::Mat& interpolation) {
  GrayImage out;
  cv::remap(image.pixels, out.pixels, map, interpolation, cv::INTER_LINEAR, cv::BORDER_CONSTANT);
  return out;
}

}  // namespace

Rectifier::Rectifier(const StereoRig& rig, const RectificationParams& params) {
  if (rig.is_rectified) {
    camera_ = {rig.left.pinhole, rig.baseline_m()};
    return;
  }
  const RectifyingTransforms to = rectifying_transforms(rig, params.alpha);
  camera_.pinhole = {rig.left.pinhole.width, rig.left.pinhole.height, to.P_left(0, 0),
                     to.P_left(1, 1),        to.P_left(0, 2),         to.P_left(1, 2)};
  camera_.baseline_m = -to.P_right(0, 3) / to.P_right(0, 0);
  T_left_rectified_ = inverse(pure_rotation(to.R_left));
  left_ = make_warp(rig.left, to.R_left, to.P_left);
  right_ = make_warp(rig.right, to.R_right, to.P_right);
}

Rectifier::Warp Rectifier::make_warp(const CameraCalibration& camera, const cv::Mat& R,
                                     const cv::Mat& P) {
  const cv::Mat1d K = camera_matrix(camera.pinhole), D = coefficients(camera);
  const cv::Size size(camera.pinhole.width, camera.pinhole.height);
  Warp warp;
  if (camera.distortion_model == DistortionModel::equidistant)
    cv::fisheye::initUndistortRectifyMap(K, D, R, P, size, CV_16SC2, warp.map, warp.interpolation);
  else
    cv::initUndistortRectifyMap(K, D, R, P, size, CV_16SC2, warp.map, warp.interpolation);
  // Any interpolation with a pixel outside leaves less than full white.
  const cv::Mat1b white(size, 255);
  cv::remap(white, warp.valid, warp.map, warp.interpolation, cv::INTER_LINEAR, cv::BORDER_CONSTANT);
  warp.valid = warp.valid == 255;
  return warp;
}

RectifiedPair Rectifier::rectify(const StereoFrame& frame) const {
  if (left_.map.empty()) return {frame.stamp_ns, frame.left, frame.right, {}, {}};
  return {frame.stamp_ns, warped(frame.left, left_.map, left_.interpolation),
          warped(frame.right, right_.map, right_.interpolation), left_.valid, right_.valid};
}

}  // namespace stereovox
