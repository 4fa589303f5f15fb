// The rules by which an observation O_t in [0, 1] changes a voxel. There are two kinds, told apart
// by what a rule has; to add a rule, write its header and name it here.
//
//   weighing: S <- (1 - k) S + k O (eq. 14) with k = credibility(CredibilityInput) in [0, 1] by eq.
//             (16); age_factor(seconds since the last observation) is not asked for the first one,
//             which has 1.
//   adding:   after(belief, observation) is the new belief; the first one starts from kNoBelief.
//             With kKeepsIgnorance = true beliefs keep their ignorance, which else is 0.
//
// VisibilityRule adds too, but also asks how visible the voxel is (frame_visibility.h).
//
// An observation of 0 is a miss, a larger one a hit, but for a rule with a member `profile`: that
// is what the frame is observed with (surface_profile.h), and 0.5 divides free from occupied.
#pragma once

#include <variant>

#include "stereovox/occupancy/continuous_log_odds_rule.h"
#include "stereovox/occupancy/dempster_shafer_rule.h"
#include "stereovox/occupancy/frequency_rule.h"
#include "stereovox/occupancy/literal_rules.h"
#include "stereovox/occupancy/log_odds_rule.h"
#include "stereovox/occupancy/saturating_rule.h"
#include "stereovox/occupancy/visibility_rule.h"

namespace stereovox {

using UpdateRule =
    std::variant<LiteralRule, LiteralScaledRule, FrequencyRule, SaturatingRule, LogOddsRule,
                 ContinuousLogOddsRule, VisibilityRule, DempsterShaferRule>;

template <class Rule>
concept WeighingRule = requires(const Rule& rule, const CredibilityInput& input) {
  rule.credibility(input);
};

template <class Rule>
concept AddingRule = requires(const Rule& rule, const VoxelBelief& belief, float observation) {
  rule.after(belief, observation);
};

template <class Rule>
concept KeepsIgnorance = AddingRule<Rule> && Rule::kKeepsIgnorance;

// The profile that the rule observes a frame with; nullptr when it has none of its own.
inline const SurfaceProfile* profile_of(const UpdateRule& update) {
  return std::visit(
      [](const auto& rule) -> const SurfaceProfile* {
        if constexpr (requires { rule.profile; })
          return &rule.profile;
        else
          return nullptr;
      },
      update);
}

}  // namespace stereovox
