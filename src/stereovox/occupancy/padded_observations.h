// The observations of a block and of the voxels around it, and how much they differ (eq. 15). Says
// bit for bit what heterogeneity() says of each voxel.
#pragma once

#include <array>

#include "stereovox/occupancy/frame_observation.h"
#include "stereovox/occupancy/homogeneity.h"
#include "stereovox/occupancy/vector_target.h"

namespace stereovox {

class PaddedObservations {
 public:
  PaddedObservations(const FrameObservation& frame, const BlockObservation& center);

  // When nothing near is hit, every observation near is 0 and so is H.
  bool is_uniform() const { return !has_hits_; }

  // H of the voxels of a layer; of those that are not observed it is nonsense.
  void heterogeneities(int layer, const HomogeneityParams& params, PerVoxelOfLayer<double>& out,
                       VectorTarget target = best_target()) const;

 private:
  static constexpr int kSide = kBlockSide + 2;  // with a border of one voxel

  void copy_overlap(const BlockObservation& block, const Eigen::Vector3i& step);

  // Not while uniform. The last ones are read but not used.
  std::array<float, kSide * kSide * kSide + kSide> values_;
  bool has_hits_ = false;
};

}  // namespace stereovox
