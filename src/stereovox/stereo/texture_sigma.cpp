#include "stereovox/stereo/texture_sigma.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace stereovox {

cv::Mat1f texture_sigma_px(const GrayImage& left, double base_px, double noise_gray) {
  constexpr int kNeighbourhood_px = 9;
  constexpr double kSobelSum = 8.0;     // of the weights of one side, times the step of two pixels
  constexpr float kMinGradient = 0.1F;  // less is the rounding to whole grey values
  cv::Mat1f gradient, energy;
  cv::Sobel(left.pixels, gradient, CV_32F, 1, 0, 3, 1.0 / kSobelSum);
  cv::boxFilter(gradient.mul(gradient), energy, -1, {kNeighbourhood_px, kNeighbourhood_px});
  const auto base_variance = static_cast<float>(base_px * base_px);
  const auto noise_variance = static_cast<float>(noise_gray * noise_gray);
  for (float& value : energy)
    value =
        std::sqrt(base_variance + noise_variance / std::max(value, kMinGradient * kMinGradient));
  return energy;
}

}  // namespace stereovox
