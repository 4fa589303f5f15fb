#include "stereovox/evaluation/disparity_score.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "stereovox/core/error.h"

namespace stereovox {
namespace {

constexpr double kD1Error_px = 3.0;  // KITTI 2015
constexpr double kD1RelativeError = 0.05;

bool is_disparity(float d_px) { return std::isfinite(d_px) && d_px > 0.0F; }

void require_same_size(cv::Size expected, cv::Size found, const char* what) {
  if (expected != found)
    throw Error(fmt::format("disparity: the {} is {} x {}, the truth {} x {}", what, found.width,
                            found.height, expected.width, expected.height));
}

struct ErrorSums {
  int counted = 0, valid = 0, d1 = 0;
  std::array<int, kBadThresholds_px.size()> bad = {};
  double absolute_px = 0, squared_px2 = 0, signed_px = 0;

  void add(double truth_px, double estimate_px) {
    const double error_px = estimate_px - truth_px, size_px = std::abs(error_px);
    ++valid;
    for (std::size_t i = 0; i < bad.size(); ++i) bad[i] += size_px > kBadThresholds_px[i] ? 1 : 0;
    d1 += size_px > kD1Error_px && size_px > kD1RelativeError * truth_px ? 1 : 0;
    absolute_px += size_px;
    squared_px2 += size_px * size_px;
    signed_px += error_px;
  }
};

ErrorSums sum_errors(const cv::Mat1f& truth_px, const cv::Mat1f& estimate_px,
                     const cv::Mat1b& counted) {
  ErrorSums sums;
  for (int v = 0; v < truth_px.rows; ++v)
    for (int u = 0; u < truth_px.cols; ++u) {
      if (!is_disparity(truth_px(v, u)) || (!counted.empty() && counted(v, u) == 0)) continue;
      ++sums.counted;
      if (is_disparity(estimate_px(v, u))) sums.add(truth_px(v, u), estimate_px(v, u));
    }
  return sums;
}

// Shares of `total` pixels when `extra` pixels are bad besides the summed ones.
BadPixels shares(const ErrorSums& sums, int extra, int total) {
  BadPixels result;
  if (total == 0) return result;
  const auto percent = [&](int bad) { return 100.0 * (bad + extra) / total; };
  for (std::size_t i = 0; i < sums.bad.size(); ++i) result.bad_percent[i] = percent(sums.bad[i]);
  result.d1_percent = percent(sums.d1);
  return result;
}

constexpr int kNeighbours = 3;

// The largest disparity that comes to each right pixel of row v, or 0. One more pixel at each end,
// so that element u is the pixel before right pixel u.
std::vector<float> nearest_in_right_row(const cv::Mat1f& left_px, int v) {
  std::vector<float> nearest_px(left_px.cols + 2);
  for (int u = 0; u < left_px.cols; ++u) {
    const float d_px = left_px(v, u);
    if (!is_disparity(d_px) || d_px > static_cast<float>(u)) continue;
    float& there = nearest_px[static_cast<std::size_t>(u - std::lround(d_px) + 1)];
    there = std::max(there, d_px);
  }
  return nearest_px;
}

}  // namespace

DisparityScore score_disparity(const DisparityImage& truth, const DisparityImage& estimate,
                               const cv::Mat1b& counted) {
  require_same_size(truth.disparity_px.size(), estimate.disparity_px.size(), "estimate");
  if (!counted.empty()) require_same_size(truth.disparity_px.size(), counted.size(), "mask");
  const ErrorSums sums = sum_errors(truth.disparity_px, estimate.disparity_px, counted);
  if (sums.counted == 0) throw Error("disparity: no pixel with truth to compare");

  DisparityScore score;
  score.counted_px = sums.counted;
  score.density_percent = 100.0 * sums.valid / sums.counted;
  score.missing_is_bad = shares(sums, sums.counted - sums.valid, sums.counted);
  score.valid_only = shares(sums, 0, sums.valid);
  if (sums.valid == 0) return score;
  score.mae_px = sums.absolute_px / sums.valid;
  score.rms_px = std::sqrt(sums.squared_px2 / sums.valid);
  score.bias_px = sums.signed_px / sums.valid;
  return score;
}

cv::Mat1b non_occluded(const DisparityImage& truth_left, const DisparityImage& truth_right,
                       double tolerance_px) {
  const cv::Mat1f& left_px = truth_left.disparity_px;
  const cv::Mat1f& right_px = truth_right.disparity_px;
  require_same_size(left_px.size(), right_px.size(), "truth of the right image");
  cv::Mat1b seen(left_px.size(), 0);
  for (int v = 0; v < left_px.rows; ++v)
    for (int u = 0; u < left_px.cols; ++u) {
      const float d_px = left_px(v, u);
      if (!is_disparity(d_px) || d_px > static_cast<float>(u)) continue;
      const float there_px = right_px(v, u - static_cast<int>(std::lround(d_px)));
      seen(v, u) = is_disparity(there_px) && std::abs(there_px - d_px) <= tolerance_px ? 255 : 0;
    }
  return seen;
}

cv::Mat1b non_occluded(const DisparityImage& truth_left, double tolerance_px) {
  const cv::Mat1f& left_px = truth_left.disparity_px;
  cv::Mat1b seen(left_px.size(), 0);
  for (int v = 0; v < left_px.rows; ++v) {
    const std::vector<float> nearest_px = nearest_in_right_row(left_px, v);
    for (int u = 0; u < left_px.cols; ++u) {
      const float d_px = left_px(v, u);
      if (!is_disparity(d_px) || d_px > static_cast<float>(u)) continue;
      const auto there = nearest_px.begin() + (u - static_cast<int>(std::lround(d_px)));
      const float nearest = *std::max_element(there, there + kNeighbours);
      seen(v, u) = nearest - d_px <= tolerance_px ? 255 : 0;
    }
  }
  return seen;
}

}  // namespace stereovox
