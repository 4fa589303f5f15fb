// The voxel that holds the point sees all of it, every other nothing, whatever the point's error:
// the model of OctoMap.
#pragma once

#include "stereovox/core/parameters.h"

namespace stereovox {

struct PointObservation {
  static constexpr const char* kName = "point";

  void describe(ParameterList&) {}
};

}  // namespace stereovox
