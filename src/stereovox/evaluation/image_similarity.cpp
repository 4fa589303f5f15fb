#include "stereovox/evaluation/image_similarity.h"

namespace stereovox {
namespace {

constexpr int kWindow = 7;
constexpr double kC1 = 0.01 * 0.01, kC2 = 0.03 * 0.03;  // the authors' K1, K2 for values to 1

double similarity_at(const ValueGrid& a, const ValueGrid& b, int x0, int y0) {
  double sum_a = 0, sum_b = 0, sum_aa = 0, sum_bb = 0, sum_ab = 0;
  for (int y = y0; y < y0 + kWindow; ++y)
    for (int x = x0; x < x0 + kWindow; ++x) {
      const auto i = static_cast<std::size_t>(y * a.geometry.width + x);
      sum_a += a.values[i];
      sum_b += b.values[i];
      sum_aa += a.values[i] * a.values[i];
      sum_bb += b.values[i] * b.values[i];
      sum_ab += a.values[i] * b.values[i];
    }
  constexpr double kCells = kWindow * kWindow;
  const double mean_a = sum_a / kCells, mean_b = sum_b / kCells;
  const double squares = mean_a * mean_a + mean_b * mean_b;
  const double variances = (sum_aa + sum_bb) / kCells - squares;
  const double covariance = sum_ab / kCells - mean_a * mean_b;
  return (2.0 * mean_a * mean_b + kC1) * (2.0 * covariance + kC2) /
         ((squares + kC1) * (variances + kC2));
}

}  // namespace

std::optional<double> structural_similarity(const ValueGrid& a, const ValueGrid& b) {
  const int columns = a.geometry.width - kWindow + 1, rows = a.geometry.height - kWindow + 1;
  if (columns < 1 || rows < 1) return std::nullopt;
  double sum = 0.0;
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) sum += similarity_at(a, b, x, y);
  return sum / (static_cast<double>(columns) * rows);
}

}  // namespace stereovox
