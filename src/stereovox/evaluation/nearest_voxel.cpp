#include "stereovox/evaluation/nearest_voxel.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace stereovox {
namespace {

constexpr int kAxes = 3;

std::int64_t squared(const Eigen::Vector3i& a, const Eigen::Vector3i& b) {
  return (a.cast<std::int64_t>() - b.cast<std::int64_t>()).squaredNorm();
}

}  // namespace

NearestVoxel::NearestVoxel(std::vector<Eigen::Vector3i> voxels) : voxels_(std::move(voxels)) {
  if (voxels_.empty()) throw std::logic_error("no voxel to be the nearest");
  arrange(voxels_, 0);
}

void NearestVoxel::arrange(std::span<Eigen::Vector3i> range, int axis) {
  if (range.size() < 2) return;
  const std::size_t middle = range.size() / 2;
  std::ranges::nth_element(range, range.begin() + static_cast<std::ptrdiff_t>(middle), {},
                           [axis](const Eigen::Vector3i& voxel) { return voxel[axis]; });
  arrange(range.first(middle), (axis + 1) % kAxes);
  arrange(range.subspan(middle + 1), (axis + 1) % kAxes);
}

std::int64_t NearestVoxel::squared_distance(const Eigen::Vector3i& voxel) const {
  std::int64_t best = std::numeric_limits<std::int64_t>::max();
  search(voxels_, 0, voxel, best);
  return best;
}

void NearestVoxel::search(std::span<const Eigen::Vector3i> range, int axis,
                          const Eigen::Vector3i& voxel, std::int64_t& best) const {
  if (range.empty()) return;
  const std::size_t middle = range.size() / 2;
  best = std::min(best, squared(range[middle], voxel));
  const std::int64_t beyond = std::int64_t{voxel[axis]} - range[middle][axis];
  const auto below = range.first(middle), above = range.subspan(middle + 1);
  const int next = (axis + 1) % kAxes;
  search(beyond < 0 ? below : above, next, voxel, best);
  if (beyond * beyond < best) search(beyond < 0 ? above : below, next, voxel, best);
}

}  // namespace stereovox
