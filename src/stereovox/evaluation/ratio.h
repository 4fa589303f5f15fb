// Shares that do not exist when there is nothing to share.
#pragma once

#include <cstdint>
#include <optional>

namespace stereovox {

inline std::optional<double> ratio(double part, double whole) {
  if (whole == 0.0) return std::nullopt;
  return part / whole;
}

inline std::optional<double> ratio(std::int64_t part, std::int64_t whole) {
  return ratio(static_cast<double>(part), static_cast<double>(whole));
}

// F1 of precision and recall; absent when either is, 0 when both are 0.
inline std::optional<double> harmonic_mean(std::optional<double> a, std::optional<double> b) {
  if (!a || !b) return std::nullopt;
  return *a + *b == 0.0 ? 0.0 : 2.0 * *a * *b / (*a + *b);
}

}  // namespace stereovox
