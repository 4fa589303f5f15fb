// Which voxels a straight segment crosses, in order (Amanatides and Woo, "A fast voxel traversal
// algorithm for ray tracing", 1987).
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "stereovox/core/grid_geometry.h"

namespace stereovox {

// The voxel containing `from`, then one face neighbour after another, up to the voxel containing
// `to`; none twice. Crossings of faces are computed from the voxel's index, not accumulated, and
// each axis takes exactly the steps between the two ends: rounding can swap two steps at an edge,
// but the walk cannot miss its end. Both points must be finite.
template <class Visit>
void for_each_voxel_on_segment(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                               double voxel_size_m, Visit visit) {
  Eigen::Vector3i voxel = voxel_index_of(voxel_size_m, from);
  const Eigen::Vector3i last = voxel_index_of(voxel_size_m, to);
  const Eigen::Vector3d start = from / voxel_size_m;
  const Eigen::Vector3d inverse_way = (voxel_size_m / (to - from).array()).matrix();

  // Where on the way (0 = from, 1 = to) the next face across `axis` is; never when none is left.
  const auto next_face = [&](int axis) {
    if (voxel[axis] == last[axis]) return std::numeric_limits<double>::infinity();
    const int face = voxel[axis] < last[axis] ? voxel[axis] + 1 : voxel[axis];
    return (face - start[axis]) * inverse_way[axis];
  };
  Eigen::Vector3d next(next_face(0), next_face(1), next_face(2));

  visit(static_cast<const Eigen::Vector3i&>(voxel));
  for (int steps = (last - voxel).cwiseAbs().sum(); steps > 0; --steps) {
    const int nearer_of_xy = next.x() <= next.y() ? 0 : 1;
    const int axis = next[nearer_of_xy] <= next.z() ? nearer_of_xy : 2;
    voxel[axis] += voxel[axis] < last[axis] ? 1 : -1;
    next[axis] = next_face(axis);
    visit(static_cast<const Eigen::Vector3i&>(voxel));
  }
}

}  // namespace stereovox
