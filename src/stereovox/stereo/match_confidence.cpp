#include "stereovox/stereo/match_confidence.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

namespace stereovox {
namespace {

constexpr int kHalfWindow_px = kVarianceSide_px / 2;

constexpr double kSpan = ConfidenceModel::kMaxLogit - ConfidenceModel::kMinLogit;
constexpr double kLevelsPerLogit = (CredenceTable::kLevels - 1) / kSpan;

// Of the rows about v; sums of squares wrap around, their variance does not. Two more on either
// side repeat the ends.
struct Moments {
  std::vector<std::uint32_t> sum, square_sum;

  explicit Moments(int width)
      : sum(width + 2 * kHalfWindow_px), square_sum(width + 2 * kHalfWindow_px) {}

  void add_row(const std::int16_t* disparity, int width) {
    fastest_row_kernels().add_moments(disparity, width, sum.data() + kHalfWindow_px,
                                      square_sum.data() + kHalfWindow_px);
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
  fastest_row_kernels().variances(column.sum.data(), column.square_sum.data(), width, variance_px2);
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
  const LevelRow row = {.log_ratio = features.log_ratio[v],
                        .left_right = features.left_right[v],
                        .local_cost = features.local_cost[v],
                        .variance_px2 = variance_px2.data(),
                        .bias = bias_,
                        .of_log_ratio = log_ratio_,
                        .of_left_right = left_right_,
                        .of_local_cost = local_cost_,
                        .of_variance = variance_,
                        .max_level = kLevels - 1};
  fastest_row_kernels().levels(row, width, level);
}

}  // namespace stereovox
