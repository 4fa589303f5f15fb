#include "stereovox/occupancy/smooth_disparity.h"

#include <gtest/gtest.h>

#include <numeric>
#include <random>
#include <stdexcept>

#include "stereovox/occupancy/integrate_reference.h"

namespace stereovox {
namespace {

DisparityImage image_of(int width, int height, float sigma_px) {
  return {.disparity_px = cv::Mat1f(height, width, 0.0F),
          .sigma_px = cv::Mat1f(height, width, sigma_px)};
}

DisparityImage smoothed_all(const DisparityImage& image, const SmoothingParams& params,
                            int threads = 1, VectorTarget target = best_target()) {
  std::vector<int> rows(static_cast<std::size_t>(image.height()));
  std::iota(rows.begin(), rows.end(), 0);
  return smoothed(image, params, rows, threads, target);
}

// A slanted plane.
DisparityImage plane(float sigma_px) {
  DisparityImage image = image_of(40, 30, sigma_px);
  for (int v = 0; v < 30; ++v)
    for (int u = 0; u < 40; ++u)
      image.disparity_px(v, u) = 20.0F + 0.25F * float(u) - 0.5F * float(v);
  return image;
}

void add_noise(float sigma_px, unsigned seed, DisparityImage& image) {
  std::mt19937 random(seed);
  std::normal_distribution<float> noise(0.0F, sigma_px);
  for (float& disparity_px : image.disparity_px) disparity_px += noise(random);
}

double rms(const cv::Mat1f& a, const cv::Mat1f& b) {
  return cv::norm(a, b) / std::sqrt(static_cast<double>(a.total()));
}

TEST(SmoothDisparity, RadiusZeroChangesNothing) {
  const DisparityImage image = plane(0.5F);
  EXPECT_EQ(rms(smoothed_all(image, {.radius_px = 0}).disparity_px, image.disparity_px), 0.0);
}

TEST(SmoothDisparity, SlantedPlanesStayWhereTheyAreUpToTheBorder) {
  const DisparityImage image = plane(0.5F);
  EXPECT_LT(rms(smoothed_all(image, {.radius_px = 2}).disparity_px, image.disparity_px), 1e-6);
}

TEST(SmoothDisparity, NoiseOfNeighboursAveragesOut) {
  const DisparityImage truth = plane(0.5F);
  DisparityImage noisy = truth;
  noisy.disparity_px = truth.disparity_px.clone();
  add_noise(0.5F, 1, noisy);
  const double before = rms(noisy.disparity_px, truth.disparity_px);
  const double after =
      rms(smoothed_all(noisy, {.radius_px = 3, .gate_sigmas = 6}).disparity_px, truth.disparity_px);
  EXPECT_GT(before, 0.45);
  EXPECT_LT(after, 0.2);
}

TEST(SmoothDisparity, SurfacesOfAnotherDepthAreNotMixed) {
  DisparityImage image = image_of(20, 20, 0.5F);
  for (int v = 0; v < 20; ++v)
    for (int u = 0; u < 20; ++u) image.disparity_px(v, u) = u < 10 ? 12.0F : 16.0F;
  EXPECT_EQ(
      rms(smoothed_all(image, {.radius_px = 4, .gate_sigmas = 4}).disparity_px, image.disparity_px),
      0.0);
}

TEST(SmoothDisparity, HolesStayHolesAndSpeakForNobody) {
  DisparityImage image = image_of(9, 9, 0.5F);
  image.disparity_px(4, 4) = 1.0F;  // within four sigmas of nothing, and of no disparity
  const DisparityImage smooth = smoothed_all(image, {.radius_px = 3, .gate_sigmas = 4});
  EXPECT_EQ(rms(smooth.disparity_px, image.disparity_px), 0.0);
}

TEST(SmoothDisparity, EqualsItsPlainTwinOnEveryTargetAndAnyNumberOfThreads) {
  DisparityImage image = image_of(150, 40, 0.0F);
  std::mt19937 random(7);
  std::uniform_real_distribution<float> disparity(-2.0F, 6.0F), sigma(0.0F, 1.0F);
  for (float& d : image.disparity_px) d = std::max(0.0F, disparity(random));
  for (float& s : image.sigma_px) s = sigma(random);
  image.disparity_px(3, 3) = std::numeric_limits<float>::quiet_NaN();
  image.disparity_px(5, 3) = std::numeric_limits<float>::infinity();
  image.sigma_px(9, 9) = std::numeric_limits<float>::infinity();
  for (const int radius_px : {1, 3}) {
    const SmoothingParams params{.radius_px = radius_px, .gate_sigmas = 2.5};
    const cv::Mat1f expected = smoothed_reference(image, params).disparity_px;
    for (const VectorTarget target : targets_here())
      for (const int threads : {1, 3}) {
        const cv::Mat1f found = smoothed_all(image, params, threads, target).disparity_px;
        EXPECT_EQ(std::memcmp(found.data, expected.data, found.total() * sizeof(float)), 0);
      }
    EXPECT_GT(cv::countNonZero(expected != image.disparity_px), 1000);
  }
}

TEST(SmoothDisparity, OtherRowsStayAsTheyAre) {
  DisparityImage image = plane(0.5F);
  add_noise(0.5F, 2, image);
  const SmoothingParams params{.radius_px = 2};
  const std::vector<int> rows = {4, 11};
  const cv::Mat1f some = smoothed(image, params, rows, 1).disparity_px;
  const cv::Mat1f all = smoothed_all(image, params).disparity_px;
  for (int v = 0; v < image.height(); ++v) {
    const bool is_asked = v == 4 || v == 11;
    EXPECT_EQ(cv::norm(some.row(v), (is_asked ? all : image.disparity_px).row(v)), 0.0);
  }
}

TEST(SmoothDisparity, ImagesOfDifferentSizesAreAProgrammingError) {
  DisparityImage image = image_of(8, 8, 0.5F);
  image.sigma_px = cv::Mat1f(8, 7, 0.5F);
  EXPECT_THROW(smoothed_all(image, {.radius_px = 1}), std::logic_error);
}

}  // namespace
}  // namespace stereovox
