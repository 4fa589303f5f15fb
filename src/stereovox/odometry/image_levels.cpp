#include "stereovox/odometry/image_levels.h"

#include <algorithm>
#include <array>
#include <opencv2/imgproc.hpp>

namespace stereovox {
namespace {

constexpr int kMinDisparities = 3;  // of four
// Disparities that differ by more belong to different surfaces.
constexpr float kMaxSpread_px = 2.0F;

cv::Size half_of(const cv::Size& size) { return {size.width / 2, size.height / 2}; }

template <class Image>
Image even_part(const Image& image) {
  const cv::Size half = half_of(image.size());
  return image(cv::Rect(0, 0, 2 * half.width, 2 * half.height));
}

GrayImage halved(const GrayImage& image) {
  GrayImage half{cv::Mat1b(half_of(image.pixels.size()))};
  if (!half.pixels.empty())
    cv::resize(even_part(image.pixels), half.pixels, half.pixels.size(), 0, 0, cv::INTER_AREA);
  return half;
}

// 255 where all four are.
cv::Mat1b halved_mask(const cv::Mat1b& mask) {
  cv::Mat1b half(half_of(mask.size()));
  for (int v = 0; v < half.rows; ++v)
    for (int u = 0; u < half.cols; ++u)
      half(v, u) = std::min({mask(2 * v, 2 * u), mask(2 * v, 2 * u + 1), mask(2 * v + 1, 2 * u),
                             mask(2 * v + 1, 2 * u + 1)});
  return half;
}

struct Disparity {
  float disparity_px = 0.0F, sigma_px = 0.0F;
};

Disparity disparity_of_four(const DisparityImage& image, int v, int u) {
  float sum = 0.0F, sigma_sum = 0.0F, least = 0.0F, largest = 0.0F;
  int count = 0;
  for (int dv = 0; dv < 2; ++dv)
    for (int du = 0; du < 2; ++du) {
      const float d = image.disparity_px(v + dv, u + du);
      if (d <= 0.0F) continue;
      least = count == 0 ? d : std::min(least, d);
      largest = std::max(largest, d);
      sum += d;
      sigma_sum += image.sigma_px(v + dv, u + du);
      ++count;
    }
  if (count < kMinDisparities || largest - least > kMaxSpread_px) return {};
  const float pixels = 2.0F * static_cast<float>(count);  // of the smaller image, over all
  return {sum / pixels, sigma_sum / pixels};
}

DisparityImage halved(const DisparityImage& image) {
  const cv::Size size = half_of(image.disparity_px.size());
  DisparityImage half{cv::Mat1f(size), cv::Mat1f(size)};
  for (int v = 0; v < size.height; ++v)
    for (int u = 0; u < size.width; ++u) {
      const Disparity of_four = disparity_of_four(image, 2 * v, 2 * u);
      half.disparity_px(v, u) = of_four.disparity_px;
      half.sigma_px(v, u) = of_four.sigma_px;
    }
  return half;
}

// Pixel (0, 0) is the centre of a pixel: that of the smaller image lies between four.
double halved_position(double position_px) { return (position_px - 0.5) / 2; }

}  // namespace

PairLevel halved(const PairLevel& level) {
  const RectifiedPair& pair = level.pair;
  return {.pair = {.stamp_ns = pair.stamp_ns,
                   .left = halved(pair.left),
                   .right = halved(pair.right),
                   .valid_left = halved_mask(pair.valid_left),
                   .valid_right = halved_mask(pair.valid_right)},
          .disparity = halved(level.disparity)};
}

RectifiedCamera halved(const RectifiedCamera& camera) {
  RectifiedCamera half = camera;
  half.pinhole.width /= 2;
  half.pinhole.height /= 2;
  half.pinhole.fx_px /= 2;
  half.pinhole.fy_px /= 2;
  half.pinhole.cx_px = halved_position(camera.pinhole.cx_px);
  half.pinhole.cy_px = halved_position(camera.pinhole.cy_px);
  return half;
}

}  // namespace stereovox
