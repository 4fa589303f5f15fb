#include "stereovox/odometry/image_difference.h"

#include <gtest/gtest.h>

#include <vector>

#include "stereovox/odometry/halved_levels_for_test.h"

namespace stereovox {
namespace {

constexpr Paint kPattern{.period_m = 0.3};

double ratio(const Shot& reference, const Shot& current, const SE3& T_reference_a,
             const SE3& T_reference_b) {
  const auto r = halved_levels_of(reference), c = halved_levels_of(current);
  std::vector<ViewPair> views;
  for (std::size_t i = 0; i < r.size(); ++i)
    views.push_back({r[i].camera, r[i].images, c[i].images});
  return difference_ratio(views, T_reference_a, T_reference_b);
}

SE3 to_the_right(double x_m) { return {Eigen::Quaterniond::Identity(), {x_m, 0.0, 0.0}}; }

// Less bright, and darker in the corners.
Shot through_another_lens(Shot shot) {
  for (cv::Mat1b* image : {&shot.pair.left.pixels, &shot.pair.right.pixels})
    for (int v = 0; v < image->rows; ++v)
      for (int u = 0; u < image->cols; ++u) {
        const double x = (u - kCamera.pinhole.cx_px) / kCamera.pinhole.cx_px;
        const double y = (v - kCamera.pinhole.cy_px) / kCamera.pinhole.cy_px;
        std::uint8_t& value = (*image)(v, u);
        value = cv::saturate_cast<std::uint8_t>(5.0 + 0.8 * value * (1.0 - 0.12 * (x * x + y * y)));
      }
  return shot;
}

constexpr double kClear = 0.8;

TEST(ImageDifference, IsLessAtTheTruePlaceThanAPeriodAway) {
  for (const double step_m : {-0.17, -0.11, 0.02, 0.13, 0.22}) {
    const Shot reference = shot_from(SE3{}, 1, kPattern),
               current = shot_from(to_the_right(step_m), 2, kPattern);
    for (const double period_m : {-kPattern.period_m, kPattern.period_m})
      EXPECT_LT(ratio(reference, current, to_the_right(step_m), to_the_right(step_m + period_m)),
                kClear)
          << step_m << " or " << step_m + period_m;
  }
}

TEST(ImageDifference, ExposureAndVignettingAreNone) {
  const double step_m = 0.17;
  const Shot reference = shot_from(SE3{}, 1, kPattern),
             current = through_another_lens(shot_from(to_the_right(step_m), 2, kPattern));
  EXPECT_LT(
      ratio(reference, current, to_the_right(step_m), to_the_right(step_m - kPattern.period_m)),
      kClear);
}

TEST(ImageDifference, OfAOverBIsTheInverseOfBOverA) {
  const Shot reference = shot_from(SE3{}, 1, kPattern),
             current = shot_from(to_the_right(0.1), 2, kPattern);
  const double of_a = ratio(reference, current, to_the_right(0.1), to_the_right(-0.1));
  const double of_b = ratio(reference, current, to_the_right(-0.1), to_the_right(0.1));
  EXPECT_NEAR(of_a * of_b, 1.0, 1e-9);
  EXPECT_EQ(ratio(reference, current, to_the_right(0.1), to_the_right(0.1)), 1.0);
}

TEST(ImageDifference, WhatIsNotSeenOrHasNoDistanceTellsNothing) {
  const Shot reference = shot_from(SE3{}, 1, kPattern);
  Shot unknown = reference;
  unknown.disparity.disparity_px = 0.0F;
  EXPECT_EQ(ratio(unknown, reference, SE3{}, to_the_right(0.3)), 1.0);
  EXPECT_EQ(ratio(reference, reference, SE3{}, to_the_right(100.0)), 1.0);
}

}  // namespace
}  // namespace stereovox
