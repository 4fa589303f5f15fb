// Eqs. (10) and (12) as printed: the variance of the range, in m^2, is compared with lengths.
#pragma once

#include "stereovox/occupancy/printed_shape_observation.h"

namespace stereovox {

struct LiteralObservation {
  static constexpr const char* kName = "literal";

  void describe(ParameterList&) {}

  Eigen::Vector3d reach_m(const PointMeasurement&, double half_edge_m) const {
    return Eigen::Vector3d::Constant(half_edge_m);
  }
  double observe(const PointMeasurement& point, const Eigen::Vector3d& offset_m,
                 double half_edge_m) const {
    return printed_shape(offset_m.norm(), half_edge_m,
                         distance_error_m(DistanceError::printed, point, offset_m));
  }
};

}  // namespace stereovox
