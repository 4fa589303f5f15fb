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

  // O is the least of these three, which is what makes it quick for many voxels near a point.
  [[gnu::always_inline]] double axis_ramp_m(double variance_m2) const {
    constexpr double kMinRamp_m = 1e-9;  // a point without error is an indicator, not 0/0
    const double ramp_m = kappa * std::sqrt(variance_m2);
    return ramp_m > kMinRamp_m ? ramp_m : kMinRamp_m;
  }
  [[gnu::always_inline]] static double axis_reach_m(double ramp_m, double half_edge_m) {
    return half_edge_m + 0.5 * ramp_m;
  }
  [[gnu::always_inline]] static double axis_evidence(double offset_m, double half_edge_m,
                                                     double inverse_ramp) {
    const double evidence = 0.5 + (half_edge_m - std::abs(offset_m)) * inverse_ramp;
    const double not_above = evidence < 1.0 ? evidence : 1.0;
    return not_above > 0.0 ? not_above : 0.0;
  }

  Eigen::Vector3d reach_m(const PointMeasurement& point, double half_edge_m) const {
    return per_axis(
        [&](int k) { return axis_reach_m(axis_ramp_m(variance(point, k)), half_edge_m); });
  }
  double observe(const PointMeasurement& point, const Eigen::Vector3d& offset_m,
                 double half_edge_m) const {
    return per_axis([&](int k) {
             return axis_evidence(offset_m[k], half_edge_m, 1.0 / axis_ramp_m(variance(point, k)));
           })
        .minCoeff();
  }

 private:
  template <class Function>
  static Eigen::Vector3d per_axis(Function function) {
    return {function(0), function(1), function(2)};
  }
  static double variance(const PointMeasurement& point, int axis) {
    return point.covariance_world(axis, axis);
  }
};

}  // namespace stereovox
