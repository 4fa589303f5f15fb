// Images with a meaning. The unit is in the field name; OpenCV stays at hand.
#pragma once

#include <opencv2/core/mat.hpp>

namespace stereovox {

// Brightness, 8 bit.
struct GrayImage {
  cv::Mat1b pixels;

  int width() const { return pixels.cols; }
  int height() const { return pixels.rows; }
};

// Disparity u_left - u_right of each pixel of the rectified left image, its standard deviation, and
// the probability that it is right at all.
// Invariant: all have the same size; disparity 0 means none, and is never a measurement.
struct DisparityImage {
  cv::Mat1f disparity_px;
  cv::Mat1f sigma_px;
  cv::Mat1f confidence = {};  // 0 to 1; empty = the matcher does not say

  int width() const { return disparity_px.cols; }
  int height() const { return disparity_px.rows; }
};

// An image in which no pixel has a disparity.
inline DisparityImage empty_disparities(cv::Size size) {
  return {cv::Mat1f(size, 0.0F), cv::Mat1f(size, 0.0F), cv::Mat1f(size, 0.0F)};
}

}  // namespace stereovox
