// The standard normal distribution.
#pragma once

#include <cmath>
#include <numbers>

namespace stereovox {

inline const double kSqrtTwoPi = std::sqrt(2.0 * std::numbers::pi);

inline double normal_density(double t) { return std::exp(-0.5 * t * t) / kSqrtTwoPi; }
inline double normal_cdf(double t) { return 0.5 * std::erfc(-t / std::numbers::sqrt2); }

}  // namespace stereovox
