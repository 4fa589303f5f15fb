// How right a disparity image is, in the terms of Middlebury (bad-N) and KITTI 2015 (D1).
//
//   const cv::Mat1b seen_by_both = non_occluded(truth_left, truth_right);
//   const DisparityScore score = score_disparity(truth_left, estimate, seen_by_both);
#pragma once

#include <array>

#include "stereovox/core/image.h"

namespace stereovox {

inline constexpr std::array<double, 4> kBadThresholds_px = {0.5, 1.0, 2.0, 3.0};

// Percentages of wrong pixels.
struct BadPixels {
  std::array<double, kBadThresholds_px.size()> bad_percent = {};  // error > kBadThresholds_px[i]
  double d1_percent = 0;  // error > 3 px and > 5 % of the true disparity
};

struct DisparityScore {
  int counted_px = 0;             // pixels with truth, inside the mask
  double density_percent = 0;     // of them, with an estimate
  BadPixels missing_is_bad = {};  // of all counted pixels; those without estimate count as bad
  // Of those with an estimate; all 0 when there is none. bias = mean of estimate - truth.
  BadPixels valid_only = {};
  double mae_px = 0, rms_px = 0, bias_px = 0;
};

// A disparity that is not a finite number > 0 is none. `counted` (255 = count; empty = all)
// restricts the score. Throws Error when the sizes differ or no pixel with truth is left.
DisparityScore score_disparity(const DisparityImage& truth, const DisparityImage& estimate,
                               const cv::Mat1b& counted = {});

// 255 where a left pixel with true disparity is also seen by the right camera: the right image's
// true disparity at the corresponding pixel is the same within `tolerance_px`.
cv::Mat1b non_occluded(const DisparityImage& truth_left, const DisparityImage& truth_right,
                       double tolerance_px = 1.0);

// The same from the truth of the left image alone: a pixel is hidden where another one of its row
// comes to the same place of the right image, within a pixel, and is nearer by more than the
// tolerance. What has no truth hides nothing.
cv::Mat1b non_occluded(const DisparityImage& truth_left, double tolerance_px = 1.0);

}  // namespace stereovox
