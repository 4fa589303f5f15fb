#include "stereovox/evaluation/squared_error.h"

#include <algorithm>
#include <cmath>

namespace stereovox {
namespace {

constexpr double kSmallestSum = 1e-5;  // as the tool has it
constexpr double kClip = 0.01;         // no cell is worth more than 1 + log2(0.0198) bits

template <class Counts>
MapError sum_where(const ValueGrid& n, const ValueGrid& m, const Counts& counts) {
  MapError error;
  for (std::size_t i = 0; i < n.values.size(); ++i) {
    if (!counts(n.values[i], m.values[i])) continue;
    const double difference = m.values[i] - n.values[i];
    error.sum += difference * difference;
    ++error.cells;
  }
  if (error.sum < kSmallestSum) error.sum = 0.0;
  return error;
}

}  // namespace

std::optional<double> MapError::percent() const {
  if (cells == 0) return std::nullopt;
  return 100.0 * sum / cells;
}

MapError error_over_all(const ValueGrid& normalised, const ValueGrid& generated) {
  return sum_where(normalised, generated,
                   [](double n, double m) { return n != kUnknownValue || m != kUnknownValue; });
}

MapError error_over_occupied(const ValueGrid& normalised, const ValueGrid& generated) {
  return sum_where(normalised, generated,
                   [](double n, double m) { return n > kUnknownValue || m > kUnknownValue; });
}

MatchBits match_bits(const ValueGrid& normalised, const ValueGrid& generated) {
  MatchBits bits;
  for (std::size_t i = 0; i < normalised.values.size(); ++i) {
    const double n = std::clamp(normalised.values[i], kClip, 1.0 - kClip);
    const double m = std::clamp(generated.values[i], kClip, 1.0 - kClip);
    if (n == kUnknownValue || m == kUnknownValue) continue;
    bits.sum += 1.0 + std::log2(m * n + (1.0 - m) * (1.0 - n));
    ++bits.cells;
  }
  return bits;
}

}  // namespace stereovox
