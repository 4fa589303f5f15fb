// The corrected credibility (method.md R3): k = kmax min(N + 1, N0)/N0 max(hmin, 1 - H) a(dt), N
// the number of earlier observations. With kmax = 1/sqrt(2 pi) and N0 = 10 it has the printed
// scale.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <string>

#include "stereovox/occupancy/credibility_input.h"

namespace stereovox {

// What a gap in the observations does: `discount_new` trusts the next observation less, as printed,
// a = exp(-dt/tau); `prior_decay` trusts the old state less, k = 1 - (1 - k0) exp(-dt/tau).
enum class AgeMode { discount_new, prior_decay };
std::span<const std::string> names_of(AgeMode);

struct SaturatingRule {
  static constexpr const char* kName = "saturating";

  double max_credibility = 0.2;
  int full_observations = 5;
  double age_time_constant_s = 10.0;
  AgeMode age_mode = AgeMode::discount_new;
  double max_decay_credibility = 0.6;

  void describe(ParameterList& list) {
    list("max_credibility", max_credibility, {0.001, 1}, "kmax: largest weight of an observation");
    list("full_observations", full_observations, {1, 1000}, "N0: observations that give kmax");
    list("age_time_constant_s", age_time_constant_s, {0.01, 1e6}, "tau of the age term");
    list("age_mode", age_mode, "a gap discounts the new observation, or the old state");
    list("max_decay_credibility", max_decay_credibility, {0, 1},
         "limit of what prior_decay raises the weight to");
  }

  double age_factor(double age_s) const { return std::exp(-age_s / age_time_constant_s); }
  double credibility(const CredibilityInput& in) const {
    const double confidence =
        std::min(in.prior_observations + 1.0, double(full_observations)) / full_observations;
    const double fresh = max_credibility * confidence * in.homogeneity;
    if (age_mode == AgeMode::discount_new) return fresh * in.age_factor;
    const double decayed = 1.0 - (1.0 - fresh) * in.age_factor;
    return std::max(fresh, std::min(decayed, max_decay_credibility));
  }
};

}  // namespace stereovox
