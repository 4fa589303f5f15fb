#include "stereovox/stereo/match_confidence.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

namespace stereovox {
namespace {

constexpr int kHalfWindow_px = 2;
constexpr int kWindow_px = 2 * kHalfWindow_px + 1;
constexpr float kStepsPerPixel = 4.0F;  // of the disparities whose variance is summed
// 1 + variance is rounded to sixteen steps in each power of two: to these bits of a float.
constexpr int kDroppedBits = 19;
constexpr double kStepsPerOctave = 16.0;
constexpr std::uint32_t kBitsOfOne = std::bit_cast<std::uint32_t>(1.0F);

// In whole steps; sums of squares wrap around, their variance does not.
struct Moments {
  std::vector<std::uint32_t> sum, square_sum;

  explicit Moments(int width) : sum(width), square_sum(width) {}
  void add_row(const float* disparity_px) {
    for (std::size_t u = 0; u < sum.size(); ++u) {
      const auto steps =
          static_cast<std::uint32_t>(static_cast<std::int32_t>(kStepsPerPixel * disparity_px[u]));
      sum[u] += steps;
      square_sum[u] += steps * steps;
    }
  }
};

double probability(double logit) { return 1.0 / (1.0 + std::exp(-logit)); }

}  // namespace

CredenceTable::CredenceTable(const ConfidenceModel& model) {
  constexpr double kSpan = ConfidenceModel::kMaxLogit - ConfidenceModel::kMinLogit;
  constexpr double kLevelsPerLogit = (kLevels - 1) / kSpan;
  const auto in_levels = [](double logit) { return static_cast<float>(logit * kLevelsPerLogit); };
  constexpr double kRounding = 0.5;
  bias_ = in_levels(model.bias - ConfidenceModel::kMinLogit) + static_cast<float>(kRounding);
  ratio_ = in_levels(model.ratio);
  left_right_ = in_levels(model.left_right);
  for (int step = 0; step < kLevels; ++step) {
    const double log_variance = (step + kRounding) / kStepsPerOctave * std::log(2.0);
    variance_term_[step] = in_levels(model.variance * (step == 0 ? 0.0 : log_variance));
  }
  for (int level = 0; level < kLevels; ++level) {
    const int bin = level * ConfidenceModel::kSigmaBins / kLevels;
    const double logit = ConfidenceModel::kMinLogit + level / kLevelsPerLogit;
    levels_[level] = {static_cast<float>(probability(logit)),
                      static_cast<float>(model.sigma_px[bin])};
  }
}

Credence CredenceTable::of(float log_ratio, float left_right_px, float variance_px2) const {
  const float raised = 1.0F + std::min(variance_px2, kMaxVariance_px2);
  const std::uint32_t step = (std::bit_cast<std::uint32_t>(raised) - kBitsOfOne) >> kDroppedBits;
  const float level = bias_ + ratio_ * std::min(log_ratio, kMaxLogRatio) -
                      left_right_ * std::min(left_right_px, kMaxLeftRight_px) -
                      variance_term_[step];
  return levels_[static_cast<int>(std::clamp(level, 0.0F, static_cast<float>(kLevels - 1)))];
}

void fill_variance_row(MatchFeatures& features, int v) {
  const cv::Mat1f& disparity_px = features.disparity_px;
  const int width = disparity_px.cols;
  Moments column(width);
  for (int dv = -kHalfWindow_px; dv <= kHalfWindow_px; ++dv)
    column.add_row(disparity_px[std::clamp(v + dv, 0, disparity_px.rows - 1)]);

  constexpr int kArea = kWindow_px * kWindow_px;
  constexpr float kToVariance = 1.0F / (kArea * kArea * kStepsPerPixel * kStepsPerPixel);
  float* const out = features.variance_px2[v];
  const auto variance = [&](auto neighbour) {
    std::uint32_t sum = 0, square_sum = 0;
    for (int du = -kHalfWindow_px; du <= kHalfWindow_px; ++du) {
      sum += column.sum[neighbour(du)];
      square_sum += column.square_sum[neighbour(du)];
    }
    return kToVariance *
           static_cast<float>(static_cast<std::int32_t>(kArea * square_sum - sum * sum));
  };
  const auto at_border = [&](int u) {
    out[u] = variance([&](int du) { return std::clamp(u + du, 0, width - 1); });
  };
  for (int u = 0; u < std::min(kHalfWindow_px, width); ++u) at_border(u);
  for (int u = kHalfWindow_px; u < width - kHalfWindow_px; ++u)
    out[u] = variance([u](int du) { return u + du; });
  for (int u = std::max(kHalfWindow_px, width - kHalfWindow_px); u < width; ++u) at_border(u);
}

}  // namespace stereovox
