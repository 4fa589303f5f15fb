#include "stereovox/evaluation/correlation.h"

#include <algorithm>
#include <cmath>

namespace stereovox {
namespace {

// Of values less kUnknownValue, so that cells beyond a map add nothing.
struct Sums {
  double values = 0, squares = 0;
};

Sums sums_of(const ValueGrid& grid) {
  Sums sums;
  for (const double value : grid.values) {
    const double v = value - kUnknownValue;
    sums.values += v;
    sums.squares += v * v;
  }
  return sums;
}

double sum_of_products(const ValueGrid& a, const ValueGrid& b, const Eigen::Vector2i& offset) {
  const Eigen::Vector2i first = offset.cwiseMax(0);
  const Eigen::Vector2i end = (offset + Eigen::Vector2i(b.geometry.width, b.geometry.height))
                                  .cwiseMin(Eigen::Vector2i(a.geometry.width, a.geometry.height));
  double sum = 0.0;
  for (int y = first.y(); y < end.y(); ++y)
    for (int x = first.x(); x < end.x(); ++x) {
      const int in_a = y * a.geometry.width + x;
      const int in_b = (y - offset.y()) * b.geometry.width + x - offset.x();
      sum += (a.values[static_cast<std::size_t>(in_a)] - kUnknownValue) *
             (b.values[static_cast<std::size_t>(in_b)] - kUnknownValue);
    }
  return sum;
}

double cells_of_union(const GridGeometry& a, const GridGeometry& b, const Eigen::Vector2i& offset) {
  const Eigen::Array2d first = offset.cast<double>().array().min(0.0);
  const Eigen::Array2d end = (offset.cast<double>().array() + Eigen::Array2d(b.width, b.height))
                                 .max(Eigen::Array2d(a.width, a.height));
  return (end - first).prod();
}

struct Pair {
  const ValueGrid &a, &b;
  Sums sums_a = sums_of(a), sums_b = sums_of(b);
  Eigen::Vector2i offset = lattice_offset(a.geometry, b.geometry);

  Correlation at(const Eigen::Vector2i& shift) const {
    const double n = cells_of_union(a.geometry, b.geometry, offset + shift);
    const double mean_a = sums_a.values / n, mean_b = sums_b.values / n;
    const double variance_a = sums_a.squares / n - mean_a * mean_a;
    const double variance_b = sums_b.squares / n - mean_b * mean_b;
    constexpr double kRounding = 1e-12;  // of a variance of values in [0, 1]
    if (variance_a < kRounding || variance_b < kRounding) return {0.0, true};
    const double covariance = sum_of_products(a, b, offset + shift) / n - mean_a * mean_b;
    return {std::clamp(covariance / std::sqrt(variance_a * variance_b), -1.0, 1.0), false};
  }
};

}  // namespace

Correlation correlation(const ValueGrid& a, const ValueGrid& b,
                        const Eigen::Vector2i& shift_cells) {
  return Pair{a, b}.at(shift_cells);
}

BestShift best_shift(const ValueGrid& a, const ValueGrid& b, int max_shift_cells) {
  const Pair pair{a, b};
  BestShift best{pair.at({0, 0}).coefficient, {0, 0}};
  for (int dy = -max_shift_cells; dy <= max_shift_cells; ++dy)
    for (int dx = -max_shift_cells; dx <= max_shift_cells; ++dx) {
      const BestShift here{pair.at({dx, dy}).coefficient, {dx, dy}};
      const bool is_shorter = here.shift_cells.squaredNorm() < best.shift_cells.squaredNorm();
      if (here.coefficient > best.coefficient ||
          (here.coefficient == best.coefficient && is_shorter))
        best = here;
    }
  return best;
}

double truncated_to_4_decimals(double coefficient) {
  constexpr double kDecimals = 1e4;
  return std::trunc(coefficient * kDecimals) / kDecimals;
}

}  // namespace stereovox
