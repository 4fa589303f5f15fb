#include "stereovox/occupancy/padded_observations.h"

#include <gtest/gtest.h>

#include <random>

namespace stereovox {
namespace {

// 2 x 2 x 2 blocks of which about a third of the voxels are observed, some as hits.
FrameObservation random_observation(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> share(0.0F, 1.0F);
  FrameObservation frame;
  for (int i = 0; i < 8; ++i) {
    BlockObservation block{{i & 1, i >> 1 & 1, i >> 2}, {}, {}, {}};
    const bool has_hits = i % 3 != 1;
    if (has_hits) block.values.assign(kVoxelsPerBlock, kUnobserved);
    for (int at = 0; at < kVoxelsPerBlock; ++at) {
      if (share(random) > 0.35F) continue;
      block.observed.set(at);
      if (has_hits)
        block.values[static_cast<std::size_t>(at)] = share(random) > 0.5F ? share(random) : 0.0F;
    }
    frame.index.find_or_insert(block.index);
    frame.blocks.push_back(block);
  }
  return frame;
}

float observation_at(const FrameObservation& frame, const Eigen::Vector3i& voxel) {
  const int number = frame.index.find(block_of(voxel));
  return number == BlockIndex::kNone
             ? kUnobserved
             : frame.blocks[static_cast<std::size_t>(number)].value_at(position_in_block(voxel));
}

double plain_heterogeneity(const FrameObservation& frame, const Eigen::Vector3i& voxel,
                           const HomogeneityParams& params) {
  std::vector<float> around;
  for (const Eigen::Vector3i& step : neighbour_steps(params.neighbours))
    around.push_back(observation_at(frame, voxel + step));
  return heterogeneity(params, observation_at(frame, voxel), around);
}

TEST(PaddedObservations, DifferAsMuchAsEachVoxelFromItsNeighboursOnEveryTarget) {
  const FrameObservation frame = random_observation(1);
  PerVoxelOfLayer<double> found;
  for (const auto neighbours : {Neighbourhood::faces, Neighbourhood::cube})
    for (const auto unobserved :
         {UnobservedNeighbours::excluded, UnobservedNeighbours::count_as_zero})
      for (const VectorTarget target : targets_here())
        for (const BlockObservation& block : frame.blocks)
          for (int z = 0; z < kBlockSide; ++z) {
            const HomogeneityParams params{neighbours, unobserved, 0.0};
            PaddedObservations(frame, block).heterogeneities(z, params, found, target);
            for (int i = 0; i < kBlockSide * kBlockSide; ++i) {
              const int position = z * kBlockSide * kBlockSide + i;
              if (!block.observed.contains(position)) continue;
              EXPECT_EQ(found[static_cast<std::size_t>(i)],
                        plain_heterogeneity(frame, voxel_at(block.index, position), params));
            }
          }
}

TEST(PaddedObservations, AreUniformOnlyFarFromHits) {
  FrameObservation frame = random_observation(2);
  for (const BlockObservation& block : frame.blocks)
    EXPECT_FALSE(PaddedObservations(frame, block).is_uniform());
  for (BlockObservation& block : frame.blocks) block.values.clear();
  EXPECT_TRUE(PaddedObservations(frame, frame.blocks.front()).is_uniform());
}

}  // namespace
}  // namespace stereovox
