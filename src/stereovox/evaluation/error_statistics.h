// Summary of a list of errors, with the definitions of evo: population standard deviation, median
// of an even count = mean of the middle two, sse = sum of squares.
#pragma once

#include <span>

namespace stereovox {

// In the unit of the errors (sse in its square). Without errors, count is 0 and the rest means
// nothing.
struct ErrorStatistics {
  double rmse = 0, mean = 0, median = 0, std = 0, min = 0, max = 0, sse = 0;
  int count = 0;
};

ErrorStatistics statistics_of(std::span<const double> errors);

}  // namespace stereovox
