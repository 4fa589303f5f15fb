#include "stereovox/simulation/sensor.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "stereovox/core/parallel.h"
#include "stereovox/simulation/material.h"

namespace stereovox {
namespace {

constexpr double kWhite = 255.0;
// Exposure control cannot follow a dark room without end.
constexpr double kMinMeanRadiance = 0.02;

// Nearly normal with variance 1: the sum of the four bytes of a hash, each uniform.
float deviate(int u, int v, std::uint32_t seed) {
  const std::uint32_t bits = hash_of(u, v, 0, seed);
  const std::uint32_t sum = (bits & 255) + (bits >> 8 & 255) + (bits >> 16 & 255) + (bits >> 24);
  constexpr float kMean = 4 * 127.5F, kDeviation = 147.8F;  // sqrt(4 (256^2 - 1) / 12)
  return (static_cast<float>(sum) - kMean) / kDeviation;
}

// 1 in the middle, 1 - vignetting in the corners.
float falloff(int u, int v, const cv::Size& size, double vignetting) {
  const double x = (2.0 * u + 1) / size.width - 1, y = (2.0 * v + 1) / size.height - 1;
  return static_cast<float>(1 - vignetting * (x * x + y * y) / 2);
}

}  // namespace

void SensorParams::describe(ParameterList& list) {
  list("blur_px", blur_px, {0, 10}, "standard deviation of the lens blur");
  list("vignetting", vignetting, {0, 1}, "share of the light that is lost in the corners");
  list("mean_gray", mean_gray, {1, 254}, "mean grey value that exposure control aims at");
  list("gain_difference", gain_difference, {-0.5, 0.5},
       "by how much the right camera is brighter than the left one");
  list("full_well_electrons", full_well_electrons, {10, 1e6},
       "light of a white pixel; fewer electrons mean more shot noise");
  list("read_noise_gray", read_noise_gray, {0, 50}, "standard deviation of the noise in the dark");
}

double exposure_of(const cv::Mat1f& radiance, const SensorParams& params) {
  return params.mean_gray / std::max(cv::mean(radiance)[0], kMinMeanRadiance);
}

GrayImage expose(const cv::Mat1f& radiance, double gray_per_radiance, const SensorParams& params,
                 std::uint32_t seed, int threads) {
  cv::Mat1f light = radiance;
  if (params.blur_px > 0)
    cv::GaussianBlur(radiance, light, {}, params.blur_px, 0, cv::BORDER_REPLICATE);
  const auto gain = static_cast<float>(gray_per_radiance);
  const auto shot_variance = static_cast<float>(kWhite / params.full_well_electrons);
  const auto read_variance = static_cast<float>(params.read_noise_gray * params.read_noise_gray);
  GrayImage image{cv::Mat1b(light.size())};
  parallel_for(0, light.rows, threads, [&](int v) {
    for (int u = 0; u < light.cols; ++u) {
      const float gray = gain * light(v, u) * falloff(u, v, light.size(), params.vignetting);
      const float sigma = std::sqrt(shot_variance * gray + read_variance);
      image.pixels(v, u) = cv::saturate_cast<uchar>(gray + sigma * deviate(u, v, seed));
    }
  });
  return image;
}

}  // namespace stereovox
