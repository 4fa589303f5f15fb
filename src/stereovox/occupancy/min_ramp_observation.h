// The corrected observation of a voxel from a point (method.md, variant 4 of eq. 12):
// O = min over the axes of clamp(1/2 + (r - d_k)/(kappa s_k), 0, 1), with d_k the distance to the
// centre and s_k the standard deviation along axis k. Continuous, covers the whole cube, gives 1/2
// on a face to both voxels, and spreads along the viewing ray, where s_k is large.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "stereovox/core/parameters.h"
#include "stereovox/occupancy/stereo_error_model.h"

namespace stereovox {

struct MinRampObservation {
  static constexpr const char* kName = "min_ramp";

  // sqrt(2 pi): the ramp then has the slope of the Gaussian's distribution function.
  double kappa = std::sqrt(2.0 * std::numbers::pi);

  void describe(ParameterList& list) {
    list("kappa", kappa, {0.1, 10}, "width of the ramp in standard deviations");
  }

  Eigen::Vector3d reach_m(const PointMeasurement& point, double half_edge_m) const {
    return (half_edge_m + 0.5 * ramp_m(point).array()).matrix();
  }
  double observe(const PointMeasurement& point, const Eigen::Vector3d& offset_m,
                 double half_edge_m) const {
    const Eigen::Vector3d inside_m = half_edge_m - offset_m.array().abs();
    const double lowest = inside_m.cwiseQuotient(ramp_m(point)).minCoeff();
    return std::clamp(0.5 + lowest, 0.0, 1.0);
  }

 private:
  Eigen::Vector3d ramp_m(const PointMeasurement& point) const {
    constexpr double kMinRamp_m = 1e-9;  // a point without error is an indicator, not 0/0
    return (kappa * point.covariance_world.diagonal().cwiseSqrt()).cwiseMax(kMinRamp_m);
  }
};

}  // namespace stereovox
