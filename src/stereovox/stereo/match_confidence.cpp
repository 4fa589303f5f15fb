#include "stereovox/stereo/match_confidence.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

namespace stereovox {
namespace {

constexpr int kHalfWindow_px = 2;
constexpr int kWindow_px = 2 * kHalfWindow_px + 1;
constexpr int kArea = kWindow_px * kWindow_px;
// Variances are summed over steps of this many smaller ones: their squares then fit 32 bits.
constexpr int kCoarse = 8;
constexpr float kCoarsePerPixel = static_cast<float>(kStepsPerPixel) / kCoarse;
constexpr float kToVariance = 1.0F / (kArea * kArea * kCoarsePerPixel * kCoarsePerPixel);

constexpr double kSpan = ConfidenceModel::kMaxLogit - ConfidenceModel::kMinLogit;
constexpr double kLevelsPerLogit = (CredenceTable::kLevels - 1) / kSpan;

// Of the rows about v; sums of squares wrap around, their variance does not. Two more on either
// side repeat the ends.
struct Moments {
  std::vector<std::uint32_t> sum, square_sum;

  explicit Moments(int width)
      : sum(width + 2 * kHalfWindow_px), square_sum(width + 2 * kHalfWindow_px) {}

  void add_row(const std::int16_t* disparity, int width) {
    std::uint32_t* const sums = sum.data() + kHalfWindow_px;
    std::uint32_t* const squares = square_sum.data() + kHalfWindow_px;
    for (int u = 0; u < width; ++u) {
      const std::int32_t coarse = disparity[u] / kCoarse;
      sums[u] += static_cast<std::uint32_t>(coarse);
      squares[u] += static_cast<std::uint32_t>(coarse * coarse);
    }
  }

  void repeat_ends() {
    for (std::vector<std::uint32_t>* const row : {&sum, &square_sum}) {
      std::fill_n(row->begin(), kHalfWindow_px, (*row)[kHalfWindow_px]);
      std::fill_n(row->rbegin(), kHalfWindow_px, row->rbegin()[kHalfWindow_px]);
    }
  }
};

// At `place`, counted in bins from the start of the first.
float between(const std::array<double, ConfidenceModel::kBins>& bins, double place) {
  constexpr double kMiddle = 0.5;
  const double from_middle = std::clamp(place - kMiddle, 0.0, ConfidenceModel::kBins - 1.0);
  const auto i = std::min(static_cast<std::size_t>(from_middle), bins.size() - 2);
  return static_cast<float>(std::lerp(bins[i], bins[i + 1], from_middle - static_cast<double>(i)));
}

}  // namespace

double log_of_candidates(int candidates) {
  constexpr double kUsual = 64;
  return std::log2(candidates / kUsual);
}

float log_of_raised_variance(float variance_px2) {
  constexpr float kOnePerOctave = 0x1p-23F;
  const auto bits = std::bit_cast<std::int32_t>(1.0F + std::min(variance_px2, kMaxVariance_px2));
  return kOnePerOctave * static_cast<float>(bits - std::bit_cast<std::int32_t>(1.0F));
}

void fill_variance_row(const cv::Mat1s& disparity, int v, float* variance_px2) {
  const int width = disparity.cols;
  Moments column(width);
  for (int dv = -kHalfWindow_px; dv <= kHalfWindow_px; ++dv)
    column.add_row(disparity[std::clamp(v + dv, 0, disparity.rows - 1)], width);
  column.repeat_ends();
  const std::uint32_t *const sums = column.sum.data(), *const squares = column.square_sum.data();
  for (int u = 0; u < width; ++u) {
    std::uint32_t sum = 0, square_sum = 0;
    for (int k = 0; k < kWindow_px; ++k) {
      sum += sums[u + k];
      square_sum += squares[u + k];
    }
    variance_px2[u] =
        kToVariance * static_cast<float>(static_cast<std::int32_t>(kArea * square_sum - sum * sum));
  }
}

PixelFeatures features_at(const MatchFeatures& features, int v, int u, float variance_px2) {
  return {static_cast<float>(features.log_ratio(v, u)) / kLogRatioSteps,
          static_cast<float>(features.left_right(v, u)) / kStepsPerPixel,
          log_of_raised_variance(variance_px2), static_cast<float>(features.local_cost(v, u))};
}

CredenceTable::CredenceTable(const ConfidenceModel& model, int candidates) {
  constexpr double kRounding = 0.5;
  const auto in_levels = [](double logit) { return static_cast<float>(logit * kLevelsPerLogit); };
  const double bias = model.bias + model.candidates * log_of_candidates(candidates);
  bias_ = in_levels(bias - ConfidenceModel::kMinLogit) + static_cast<float>(kRounding);
  log_ratio_ = in_levels(model.ratio / kLogRatioSteps);
  left_right_ = in_levels(-model.left_right / kStepsPerPixel);
  variance_ = in_levels(-model.variance);
  local_cost_ = in_levels(-model.local);
  for (int level = 0; level < kLevels; ++level) {
    const double place = static_cast<double>(level) * ConfidenceModel::kBins / (kLevels - 1);
    levels_[static_cast<std::size_t>(level)] = {between(model.right, place),
                                                between(model.sigma_px, place)};
  }
}

int CredenceTable::first_level_of(double confidence) const {
  int level = 0;
  while (level < kLevels && static_cast<double>(levels_[level].confidence) < confidence) ++level;
  return level;
}

void CredenceTable::fill_level_row(const MatchFeatures& features, int v,
                                   std::uint8_t* level) const {
  const int width = features.disparity.cols;
  std::vector<float> variance_px2(width);
  fill_variance_row(features.disparity, v, variance_px2.data());
  const std::uint8_t* const log_ratio = features.log_ratio[v];
  const std::uint8_t* const left_right = features.left_right[v];
  const std::uint8_t* const local_cost = features.local_cost[v];
  const auto term = [](float weight, std::uint8_t x) { return weight * static_cast<float>(x); };
  for (int u = 0; u < width; ++u) {
    const float sum = bias_ + term(log_ratio_, log_ratio[u]) + term(left_right_, left_right[u]) +
                      variance_ * log_of_raised_variance(variance_px2[u]) +
                      term(local_cost_, local_cost[u]);
    const float limited = std::min(std::max(sum, 0.0F), static_cast<float>(kLevels - 1));
    level[u] = static_cast<std::uint8_t>(static_cast<int>(limited));
  }
}

}  // namespace stereovox
