// How far each voxel is from the nearest one of a set, exactly, up to a limit, and kept up to date
// when the set changes. Only tiles near a change are computed again, each by three passes along the
// axes over the tile and its margin; so a result does not depend on how the set came about.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "stereovox/occupancy/voxel_mask.h"
#include "stereovox/occupancy/voxel_tile.h"

namespace stereovox {

struct BlockOfSet {
  Eigen::Vector3i index;
  VoxelMask members;
};

class TruncatedDistances {
 public:
  static constexpr int kMaxLimit_voxels = 100;
  static constexpr std::uint16_t kBeyond = 0xFFFF;

  enum class Extent { space, plane };  // plane: members and questions have z = 0

  // `limit_voxels` in (0, kMaxLimit_voxels], else std::logic_error.
  TruncatedDistances(double limit_voxels, Extent extent);

  // The set has these members in these blocks from now on.
  void update(const std::vector<BlockOfSet>& blocks, int threads);

  // The square of the distance between the centres of the voxel and of the nearest member, in
  // voxels; kBeyond when it exceeds the limit.
  std::uint16_t squared_at(const Eigen::Vector3i& voxel) const;

  std::size_t memory_bytes() const;

 private:
  using BlockDistances = std::array<std::uint16_t, kVoxelsPerBlock>;

  std::vector<Eigen::Vector3i> tiles_near(const std::vector<Eigen::Vector3i>& blocks) const;
  void compute(const Eigen::Vector3i& tile);
  bool fill_rows(const Eigen::Vector3i& first, std::vector<std::uint16_t>& rows) const;
  void mark_members(const BlockOfSet& block, const Eigen::Vector3i& first,
                    std::vector<std::uint16_t>& rows) const;
  void keep(const Eigen::Vector3i& tile, const std::vector<std::uint16_t>& squared);

  Extent extent_;
  int margin_;  // voxels
  std::uint16_t largest_squared_;
  BlockIndex member_index_;
  std::vector<BlockOfSet> members_;
  BlockIndex distance_index_;
  std::vector<BlockDistances> distances_;
};

}  // namespace stereovox
