// The voxel that holds the point sees all of it, every other nothing, whatever the point's error:
// the model of OctoMap.
#pragma once

#include <algorithm>

#include "stereovox/core/parameters.h"
#include "stereovox/occupancy/stereo_error_model.h"

namespace stereovox {

struct PointObservation {
  static constexpr const char* kName = "point";

  void describe(ParameterList&) {}

  // By axes, as MinRampObservation. Voxels are half open: a point on a face lies in the upper one.
  [[gnu::always_inline]] double axis_ramp_m(double) const { return 1.0; }
  [[gnu::always_inline]] static double axis_reach_m(double, double half_edge_m) {
    return half_edge_m;
  }
  [[gnu::always_inline]] static double axis_evidence(double offset_m, double half_edge_m, double) {
    const double not_below = offset_m >= -half_edge_m ? 1.0 : 0.0;
    return offset_m < half_edge_m ? not_below : 0.0;
  }

  Eigen::Vector3d reach_m(const PointMeasurement&, double half_edge_m) const {
    return Eigen::Vector3d::Constant(half_edge_m);
  }
  double observe(const PointMeasurement&, const Eigen::Vector3d& offset_m,
                 double half_edge_m) const {
    double evidence = 1.0;
    for (const double offset : offset_m)
      evidence = std::min(evidence, axis_evidence(offset, half_edge_m, 1.0));
    return evidence;
  }
};

}  // namespace stereovox
