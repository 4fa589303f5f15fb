// Eq. (12) with its printed shape: evidence of one point for a voxel, by the distance rho to its
// centre.
#pragma once

#include "stereovox/core/parameters.h"
#include "stereovox/occupancy/stereo_error_model.h"

namespace stereovox {

// 1 for rho <= r - error; 1 - rho/r for r - error < rho <= r; 0 beyond.
inline double printed_shape(double rho_m, double half_edge_m, double error_m) {
  if (rho_m > half_edge_m) return 0.0;
  return rho_m <= half_edge_m - error_m ? 1.0 : 1.0 - rho_m / half_edge_m;
}

// The printed shape with the corrected error of the distance, which isolates the square root
// missing in eq. (10).
struct PrintedShapeObservation {
  static constexpr const char* kName = "printed_shape";

  void describe(ParameterList&) {}

  Eigen::Vector3d reach_m(const PointMeasurement&, double half_edge_m) const {
    return Eigen::Vector3d::Constant(half_edge_m);
  }
  double observe(const PointMeasurement& point, const Eigen::Vector3d& offset_m,
                 double half_edge_m) const {
    return printed_shape(offset_m.norm(), half_edge_m,
                         distance_error_m(DistanceError::corrected, point, offset_m));
  }
};

}  // namespace stereovox
