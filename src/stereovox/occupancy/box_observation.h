// Probability that the true point lies in the voxel, taking its errors along the axes as
// independent (method.md, variant 5 of eq. 12). Far away it is small even for the right voxel.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "stereovox/core/parameters.h"
#include "stereovox/occupancy/stereo_error_model.h"

namespace stereovox {

struct BoxObservation {
  static constexpr const char* kName = "box";

  double reach_sigmas = 3.0;

  void describe(ParameterList& list) {
    list("reach_sigmas", reach_sigmas, {1, 6}, "voxels farther from the point see nothing of it");
  }

  Eigen::Vector3d reach_m(const PointMeasurement& point, double half_edge_m) const {
    return (half_edge_m + reach_sigmas * sigma_m(point).array()).matrix();
  }
  double observe(const PointMeasurement& point, const Eigen::Vector3d& offset_m,
                 double half_edge_m) const {
    const Eigen::Vector3d sigma = sigma_m(point);
    double probability = 1.0;
    for (int axis = 0; axis < 3; ++axis)
      probability *= share_below((half_edge_m - offset_m[axis]) / sigma[axis]) -
                     share_below((-half_edge_m - offset_m[axis]) / sigma[axis]);
    return probability;
  }

 private:
  static Eigen::Vector3d sigma_m(const PointMeasurement& point) {
    constexpr double kMinSigma_m = 1e-9;  // a point without error is an indicator, not 0/0
    return point.covariance_world.diagonal().cwiseSqrt().cwiseMax(kMinSigma_m);
  }
  // Distribution function of the standard normal.
  static double share_below(double t) { return 0.5 * std::erfc(-t / std::numbers::sqrt2); }
};

}  // namespace stereovox
