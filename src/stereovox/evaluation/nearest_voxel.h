// The nearest of many voxels, exactly: a k-d tree, for maps too large and too empty for a distance
// transform.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace stereovox {

class NearestVoxel {
 public:
  // Throws std::logic_error when there are none.
  explicit NearestVoxel(std::vector<Eigen::Vector3i> voxels);

  // To the nearest voxel, in squared voxel edges.
  std::int64_t squared_distance(const Eigen::Vector3i& voxel) const;

 private:
  // A range is split at its middle element, along the axis `depth` modulo 3.
  static void arrange(std::span<Eigen::Vector3i> range, int axis);
  void search(std::span<const Eigen::Vector3i> range, int axis, const Eigen::Vector3i& voxel,
              std::int64_t& best) const;

  std::vector<Eigen::Vector3i> voxels_;
};

}  // namespace stereovox
