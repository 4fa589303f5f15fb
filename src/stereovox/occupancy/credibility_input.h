// What an update rule may look at when it weighs a new observation of a voxel.
#pragma once

#include <cstdint>

#include "stereovox/core/parameters.h"

namespace stereovox {

struct CredibilityInput {
  int prior_observations = 0;       // frames that observed the voxel before this one
  double homogeneity = 1.0;         // (1 - H) with its floor, in [0, 1]
  double age_factor = 1.0;          // the rule's own, of the time since the last observation
  std::uint32_t frames_before = 0;  // frames the map has seen before this one
};

}  // namespace stereovox
