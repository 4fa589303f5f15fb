// The observation models of eq. (12). A model has `observe`, the evidence in [0, 1] that one point
// gives a voxel (`offset_m` from the voxel's centre to the point), and `reach_m`, the offset along
// each axis from which on that is 0. To add one, write its header and name it here.
// PointObservation needs neither: it speaks for the voxel that holds the point.
#pragma once

#include <cmath>
#include <variant>

#include "stereovox/core/grid_geometry.h"
#include "stereovox/occupancy/box_observation.h"
#include "stereovox/occupancy/euclid_continuous_observation.h"
#include "stereovox/occupancy/literal_observation.h"
#include "stereovox/occupancy/min_ramp_observation.h"
#include "stereovox/occupancy/point_observation.h"
#include "stereovox/occupancy/printed_shape_observation.h"

namespace stereovox {

using ObservationModel =
    std::variant<LiteralObservation, PrintedShapeObservation, EuclidContinuousObservation,
                 MinRampObservation, BoxObservation, PointObservation>;

// A model whose evidence is the least of what it says along each axis of the world.
template <class Model>
concept AxisModel = requires(const Model& model) {
  model.axis_evidence(0.0, 0.0, 0.0);
};

// The voxels along one axis whose centres lie within the reach of a coordinate: first and last.
[[gnu::always_inline]] inline double first_in_reach(double p_m, double reach_m, double size_m) {
  return std::ceil((p_m - reach_m) / size_m - 0.5);
}
[[gnu::always_inline]] inline double last_in_reach(double p_m, double reach_m, double size_m) {
  return std::floor((p_m + reach_m) / size_m - 0.5);
}

// Calls visit(voxel, evidence) for each voxel within the model's reach of the point.
template <class Model, class Visit>
void for_each_observed_voxel(const Model& model, const PointMeasurement& point, double voxel_size_m,
                             Visit visit) {
  const double half_edge_m = 0.5 * voxel_size_m;
  const Eigen::Vector3d reach_m = model.reach_m(point, half_edge_m);
  Eigen::Vector3i first, last;
  for (int k = 0; k < 3; ++k) {
    first[k] = static_cast<int>(first_in_reach(point.p_world[k], reach_m[k], voxel_size_m));
    last[k] = static_cast<int>(last_in_reach(point.p_world[k], reach_m[k], voxel_size_m));
  }
  Eigen::Vector3i voxel;
  for (voxel.z() = first.z(); voxel.z() <= last.z(); ++voxel.z())
    for (voxel.y() = first.y(); voxel.y() <= last.y(); ++voxel.y())
      for (voxel.x() = first.x(); voxel.x() <= last.x(); ++voxel.x()) {
        const Eigen::Vector3d offset_m = point.p_world - voxel_center_of(voxel_size_m, voxel);
        visit(static_cast<const Eigen::Vector3i&>(voxel),
              static_cast<float>(model.observe(point, offset_m, half_edge_m)));
      }
}

template <class Visit>
void for_each_observed_voxel(const PointObservation&, const PointMeasurement& point,
                             double voxel_size_m, Visit visit) {
  visit(voxel_index_of(voxel_size_m, point.p_world), 1.0F);
}

}  // namespace stereovox
