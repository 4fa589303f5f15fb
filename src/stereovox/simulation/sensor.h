// From light to grey values: lens blur, vignetting, exposure, noise, 8 bit.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>

#include "stereovox/core/image.h"
#include "stereovox/core/parameters.h"

namespace stereovox {

struct SensorParams {
  double blur_px = 0.5;
  double vignetting = 0.15;
  double mean_gray = 105.0;
  double gain_difference = 0.03;
  double full_well_electrons = 20000.0;
  double read_noise_gray = 0.6;

  void describe(ParameterList& list);
};

// Grey value of radiance 1, so that the mean of an image becomes `mean_gray`. Both cameras of a
// pair use the one of the left image.
double exposure_of(const cv::Mat1f& radiance, const SensorParams& params);

// `seed` fixes the noise; it must differ between images.
GrayImage expose(const cv::Mat1f& radiance, double gray_per_radiance, const SensorParams& params,
                 std::uint32_t seed, int threads);

}  // namespace stereovox
