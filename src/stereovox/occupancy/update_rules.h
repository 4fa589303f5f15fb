// The rules that weigh a new observation: S <- (1 - k) S + k O (eq. 14), k in [0, 1] by eq. (16). A
// rule has `age_factor` of the seconds since the last observation (not asked for the first one,
// which has 1) and `credibility`. To add one, write its header and name it here.
#pragma once

#include <variant>

#include "stereovox/occupancy/frequency_rule.h"
#include "stereovox/occupancy/literal_rules.h"
#include "stereovox/occupancy/saturating_rule.h"

namespace stereovox {

using UpdateRule = std::variant<LiteralRule, LiteralScaledRule, FrequencyRule, SaturatingRule>;

}  // namespace stereovox
