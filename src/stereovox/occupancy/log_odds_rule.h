// The rule of OctoMap (method.md E.1): every hit and every miss adds a constant to the log-odds,
// which are clamped. A voxel starts at 0.5.
#pragma once

#include "stereovox/occupancy/binary_bayes.h"
#include "stereovox/occupancy/voxel_belief.h"

namespace stereovox {

struct LogOddsRule {
  static constexpr const char* kName = "log_odds";

  double hit_probability = 0.7;
  double miss_probability = 0.4;
  double min_hit_evidence = 0.5;
  ProbabilityLimits limits{};

  void describe(ParameterList& list) {
    list("hit_probability", hit_probability, {0.5, 0.99}, "occupancy that one hit alone gives");
    list("miss_probability", miss_probability, {0.01, 0.5}, "occupancy that one miss alone gives");
    list("min_hit_evidence", min_hit_evidence, {0, 1},
         "a surface of less evidence is no hit, nor a miss: the voxel stays as it is");
    limits.describe(list);
  }

  VoxelBelief after(const VoxelBelief& before, float observation) const {
    const bool is_miss = observation <= 0.0F;
    const bool is_hit = static_cast<double>(observation) >= min_hit_evidence;
    const double after =
        limits.clamp(bayes(before.state, is_miss ? miss_probability : hit_probability));
    return {is_miss || is_hit ? after : before.state};
  }
};

}  // namespace stereovox
