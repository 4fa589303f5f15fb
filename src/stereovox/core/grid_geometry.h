// Where the cells of a regular grid lie (eqs. 11, 17): cell (or voxel) i covers the half-open
// interval [origin + i size, origin + (i + 1) size) along each axis.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>

namespace stereovox {

// Cells of a 2D map: a bounded rectangle of square cells. The origin is the outer corner of cell
// (0, 0); row 0 has the smallest y.
struct GridGeometry {
  Eigen::Vector2d origin_m = Eigen::Vector2d::Zero();
  double cell_size_m = 0.05;
  int width = 0, height = 0;  // cells

  bool contains(const Eigen::Vector2i& cell) const {
    return cell.x() >= 0 && cell.y() >= 0 && cell.x() < width && cell.y() < height;
  }
  bool operator==(const GridGeometry&) const = default;
};

inline Eigen::Vector2i index_of(const GridGeometry& grid, const Eigen::Vector2d& p) {
  return ((p - grid.origin_m) / grid.cell_size_m).array().floor().cast<int>();
}

inline Eigen::Vector2d center_of(const GridGeometry& grid, const Eigen::Vector2i& cell) {
  return grid.origin_m + (cell.cast<double>().array() + 0.5).matrix() * grid.cell_size_m;
}

// The largest integer that is not larger. Without SSE 4.1 std::floor is a call, which takes longer
// than all else that finding a voxel takes. Values beyond int end at one of its ends: wrapping
// around there saves a second condition, with which look-ups of voxels wait for each other's
// memory.
inline int floor_to_int(double value) {
  const int towards_zero = static_cast<int>(value);
  return static_cast<int>(static_cast<unsigned>(towards_zero) -
                          static_cast<unsigned>(towards_zero > value));
}

// Voxels of the unbounded 3D lattice through the world's origin.
inline Eigen::Vector3i voxel_index_of(double voxel_size_m, const Eigen::Vector3d& p_world) {
  return {floor_to_int(p_world.x() / voxel_size_m), floor_to_int(p_world.y() / voxel_size_m),
          floor_to_int(p_world.z() / voxel_size_m)};
}

inline Eigen::Vector3d voxel_center_of(double voxel_size_m, const Eigen::Vector3i& index) {
  return (index.cast<double>().array() + 0.5).matrix() * voxel_size_m;
}

}  // namespace stereovox
