#include "stereovox/simulation/sensor.h"

#include <gmock/gmock.h>

#include <opencv2/core.hpp>

namespace stereovox {
namespace {

cv::Mat1f plain(float radiance) { return cv::Mat1f(200, 200, radiance); }

SensorParams without_vignetting() {
  SensorParams params;
  params.vignetting = 0.0;
  return params;
}

TEST(Sensor, ExposureBringsTheMeanToItsAim) {
  const SensorParams params = without_vignetting();
  const cv::Mat1f radiance = plain(0.3F);
  const GrayImage image = expose(radiance, exposure_of(radiance, params), params, 7, 1);
  EXPECT_NEAR(cv::mean(image.pixels)[0], params.mean_gray, 0.2);
}

TEST(Sensor, NoiseGrowsWithTheLight) {
  const SensorParams params = without_vignetting();
  for (const double gray : {40.0, 160.0}) {
    cv::Scalar mean, deviation;
    cv::meanStdDev(expose(plain(1.0F), gray, params, 3, 1).pixels, mean, deviation);
    const double shot = 255.0 * gray / params.full_well_electrons;
    const double rounding = 1.0 / 12;
    EXPECT_NEAR(deviation[0],
                std::sqrt(shot + params.read_noise_gray * params.read_noise_gray + rounding), 0.05)
        << gray;
  }
}

TEST(Sensor, CornersAreDarker) {
  SensorParams params;
  params.read_noise_gray = 0;
  params.full_well_electrons = 1e6;
  const GrayImage image = expose(plain(1.0F), 100, params, 3, 1);
  EXPECT_NEAR(image.pixels(100, 100), 100, 1);
  EXPECT_NEAR(image.pixels(0, 0), 100 * (1 - params.vignetting), 1);
}

TEST(Sensor, NoiseDependsOnTheSeedOnly) {
  const SensorParams params;
  const cv::Mat1b one = expose(plain(1.0F), 100, params, 3, 1).pixels;
  EXPECT_EQ(cv::norm(one, expose(plain(1.0F), 100, params, 3, 4).pixels, cv::NORM_INF), 0);
  EXPECT_GT(cv::norm(one, expose(plain(1.0F), 100, params, 4, 1).pixels, cv::NORM_INF), 0);
}

}  // namespace
}  // namespace stereovox
