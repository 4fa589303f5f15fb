// Eq. (16) as printed: k = N (1 - H) / (t0 sqrt(2 pi)) * exp(-dt / (2 sigma^2)), N the number of
// earlier observations, so a first observation changes nothing.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "stereovox/occupancy/credibility_input.h"

namespace stereovox {

inline const double kSqrtTwoPi = std::sqrt(2.0 * std::numbers::pi);

// t0 read as a constant; k grows without bound and is clamped to 1.
struct LiteralRule {
  static constexpr const char* kName = "literal";

  double t0 = 10.0;
  double two_sigma_squared_s = 10.0;

  void describe(ParameterList& list) {
    list("t0", t0, {0.01, 1e6}, "scale of the number of observations");
    list("two_sigma_squared_s", two_sigma_squared_s, {0.01, 1e6}, "time constant of the age term");
  }
  double age_factor(double age_s) const { return std::exp(-age_s / two_sigma_squared_s); }
  double credibility(const CredibilityInput& in) const {
    return std::clamp(in.prior_observations * in.homogeneity / (t0 * kSqrtTwoPi) * in.age_factor,
                      0.0, 1.0);
  }
};

// t0 = Nmax / sqrt(2 pi): k stays in [0, 1] up to Nmax observations.
struct LiteralScaledRule {
  static constexpr const char* kName = "literal_scaled";

  double max_observations = 1000.0;
  double two_sigma_squared_s = 10.0;

  void describe(ParameterList& list) {
    list("max_observations", max_observations, {1, 1e6}, "observations that give full weight");
    list("two_sigma_squared_s", two_sigma_squared_s, {0.01, 1e6}, "time constant of the age term");
  }
  double age_factor(double age_s) const { return std::exp(-age_s / two_sigma_squared_s); }
  double credibility(const CredibilityInput& in) const {
    return std::clamp(in.prior_observations / max_observations * in.homogeneity * in.age_factor,
                      0.0, 1.0);
  }
};

}  // namespace stereovox
