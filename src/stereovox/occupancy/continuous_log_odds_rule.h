// The continuous model of method.md E.7 as a rule: the frame is observed along its rays by a
// surface profile O, and the voxel's log-odds grow by logit(0.5 + c (O - 0.5)). A voxel starts at
// 0.5.
#pragma once

#include "stereovox/occupancy/binary_bayes.h"
#include "stereovox/occupancy/surface_profile.h"
#include "stereovox/occupancy/voxel_belief.h"

namespace stereovox {

struct ContinuousLogOddsRule {
  static constexpr const char* kName = "continuous_log_odds";

  double free_scale = 0.2;
  double occupied_scale = 0.4;
  SurfaceProfile profile{};  // a rule with a profile is observed by it, not by `observation`
  ProbabilityLimits limits{};

  void describe(ParameterList& list) {
    list("free_scale", free_scale, {0.01, 0.99}, "c where the profile is below 0.5");
    list("occupied_scale", occupied_scale, {0.01, 0.99}, "c where the profile is above 0.5");
    profile.describe(list);
    limits.describe(list);
  }

  // Occupancy that this profile alone gives.
  double evidence(double profile_value) const {
    const double beyond = profile_value - kProfileNeutral;
    return kProfileNeutral + (beyond < 0.0 ? free_scale : occupied_scale) * beyond;
  }
  VoxelBelief after(const VoxelBelief& before, float observation) const {
    return {limits.clamp(bayes(before.state, evidence(static_cast<double>(observation))))};
  }
};

}  // namespace stereovox
