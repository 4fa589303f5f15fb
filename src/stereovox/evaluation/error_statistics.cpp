#include "stereovox/evaluation/error_statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace stereovox {

ErrorStatistics statistics_of(std::span<const double> errors) {
  if (errors.empty()) return {};
  std::vector<double> sorted(errors.begin(), errors.end());
  std::ranges::sort(sorted);
  const std::size_t half = sorted.size() / 2;
  const auto count = static_cast<double>(sorted.size());

  ErrorStatistics s;
  s.count = static_cast<int>(sorted.size());
  s.min = sorted.front();
  s.max = sorted.back();
  s.median = sorted.size() % 2 == 1 ? sorted[half] : 0.5 * (sorted[half - 1] + sorted[half]);
  s.mean = std::accumulate(sorted.begin(), sorted.end(), 0.0) / count;
  s.sse = std::inner_product(sorted.begin(), sorted.end(), sorted.begin(), 0.0);
  s.rmse = std::sqrt(s.sse / count);
  double squared_deviations = 0.0;
  for (const double e : sorted) squared_deviations += (e - s.mean) * (e - s.mean);
  s.std = std::sqrt(squared_deviations / count);
  return s;
}

}  // namespace stereovox
