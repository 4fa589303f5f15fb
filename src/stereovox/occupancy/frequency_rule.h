// Eq. (16) with t0 read as the first instant and time counted in frames (method.md R2): the share
// of the frames that observed the voxel, this one included, over sqrt(2 pi). It punishes whatever
// comes into view late; for comparison only.
#pragma once

#include "stereovox/occupancy/literal_rules.h"

namespace stereovox {

struct FrequencyRule {
  static constexpr const char* kName = "frequency";

  void describe(ParameterList&) {}
  double age_factor(double) const { return 1.0; }
  double credibility(const CredibilityInput& in) const {
    return (in.prior_observations + 1.0) / (in.frames_before + 1.0) * in.homogeneity / kSqrtTwoPi;
  }
};

}  // namespace stereovox
