// Eq. (12) without its jump: 1 for rho <= r - error, then a ramp (r - rho)/error down to 0 at r.
#pragma once

#include <algorithm>

#include "stereovox/core/parameters.h"
#include "stereovox/occupancy/stereo_error_model.h"

namespace stereovox {

struct EuclidContinuousObservation {
  static constexpr const char* kName = "euclid_continuous";

  DistanceError distance_error = DistanceError::corrected;

  void describe(ParameterList& list) {
    list("distance_error", distance_error,
         "eq. (10): standard deviation of the distance to the voxel, or the printed variance");
  }

  Eigen::Vector3d reach_m(const PointMeasurement&, double half_edge_m) const {
    return Eigen::Vector3d::Constant(half_edge_m);
  }
  double observe(const PointMeasurement& point, const Eigen::Vector3d& offset_m,
                 double half_edge_m) const {
    const double inside_m = half_edge_m - offset_m.norm();
    if (inside_m < 0.0) return 0.0;
    const double error_m = distance_error_m(distance_error, point, offset_m);
    return inside_m >= error_m ? 1.0 : inside_m / error_m;
  }
};

}  // namespace stereovox
