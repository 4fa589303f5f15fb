#include "stereovox/stereo/match_confidence.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <memory>

namespace stereovox {
namespace {

constexpr int kHalfWindow_px = kVarianceSide_px / 2;

constexpr double kSpan = ConfidenceModel::kMaxLogit - ConfidenceModel::kMinLogit;
constexpr double kLevelsPerLogit = (CredenceTable::kLevels - 1) / kSpan;

// Memory for one number of each pixel of a row, which holds none yet.
template <class T>
std::unique_ptr<T[]> memory_for_row(int width) {      // NOLINT: a plain array for the kernels
  return std::make_unique_for_overwrite<T[]>(width);  // NOLINT
}

// Two more on either side repeat the ends.
void repeat_ends(std::uint32_t* row, int width) {
  std::fill_n(row - kHalfWindow_px, kHalfWindow_px, row[0]);
  std::fill_n(row + width, kHalfWindow_px, row[width - 1]);
}

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
  const int width = disparity.cols, padded_width = width + 2 * kHalfWindow_px;
  std::array<const std::int16_t*, kVarianceSide_px> rows = {};
  for (int k = 0; k < kVarianceSide_px; ++k)
    rows[k] = disparity[std::clamp(v + k - kHalfWindow_px, 0, disparity.rows - 1)];
  const auto memory = memory_for_row<std::uint32_t>(2 * padded_width);
  std::uint32_t* const sum = memory.get() + kHalfWindow_px;
  std::uint32_t* const square_sum = sum + padded_width;
  fastest_row_kernels().moments(rows.data(), width, sum, square_sum);
  repeat_ends(sum, width);
  repeat_ends(square_sum, width);
  fastest_row_kernels().variances(memory.get(), memory.get() + padded_width, width, variance_px2);
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
  const auto variance_px2 = memory_for_row<float>(width);
  fill_variance_row(features.disparity, v, variance_px2.get());
  const LevelRow row = {.log_ratio = features.log_ratio[v],
                        .left_right = features.left_right[v],
                        .local_cost = features.local_cost[v],
                        .variance_px2 = variance_px2.get(),
                        .bias = bias_,
                        .of_log_ratio = log_ratio_,
                        .of_left_right = left_right_,
                        .of_local_cost = local_cost_,
                        .of_variance = variance_,
                        .max_level = kLevels - 1};
  fastest_row_kernels().levels(row, width, level);
}

}  // namespace stereovox
