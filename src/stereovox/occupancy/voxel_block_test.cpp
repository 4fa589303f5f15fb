#include "stereovox/occupancy/voxel_block.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace stereovox {
namespace {

Voxel random_voxel(std::mt19937& random, std::uint32_t time_ms) {
  std::uniform_real_distribution<float> state(0.0F, 1.0F);
  return {state(random), time_ms, std::uint16_t(random() % 65536),
          std::uint16_t(random() % 3 == 0 ? random() : 0)};
}

TEST(BlockVoxels, RememberWhatWasSetLast) {
  std::mt19937 random(8);
  BlockVoxels voxels;
  std::vector<Voxel> plain(kVoxelsPerBlock);
  for (std::uint32_t i = 0; i < 20'000; ++i) {
    const std::size_t position = random() % plain.size();
    voxels.set(position, plain[position] = random_voxel(random, 7 * i));
  }
  for (std::size_t i = 0; i < plain.size(); ++i) EXPECT_EQ(voxels[i], plain[i]);
}

TEST(BlockVoxels, KeepNoMoreTimesThanTwiceTheVoxels) {
  BlockVoxels voxels;
  for (std::uint32_t i = 0; i < 100'000; ++i) voxels.set(i % 3, {0.5F, i, 1});
  EXPECT_LE(voxels.extra_bytes(), 2 * kVoxelsPerBlock * sizeof(std::uint32_t));
  EXPECT_EQ(voxels[0].last_seen_ms, 99'999U);
}

TEST(BlockVoxels, TakeMemoryForIgnoranceOnlyWhereThereIsSome) {
  BlockVoxels voxels;
  voxels.set(3, {0.5F, 10, 1});
  EXPECT_LT(voxels.extra_bytes(), 100U);
  EXPECT_FALSE(voxels.has_ignorance());
  voxels.set(3, {0.5F, 10, 1, 9});
  EXPECT_TRUE(voxels.has_ignorance());
  EXPECT_EQ(voxels[3].ignorance, 9);
  EXPECT_EQ(voxels[4], Voxel{});
}

TEST(BlockVoxels, ACopyIsIndependent) {
  BlockVoxels voxels;
  voxels.set(3, {0.5F, 10, 1, 9});
  BlockVoxels copy = voxels;
  copy.set(3, {0.25F, 20, 2, 4});
  EXPECT_EQ(voxels[3], (Voxel{0.5F, 10, 1, 9}));
  EXPECT_EQ(copy[3], (Voxel{0.25F, 20, 2, 4}));
}

// With and without later times and ignorance, which layers as a whole know nothing of.
TEST(BlockVoxels, ALayerIsObservedAsEachOfItsVoxelsIs) {
  std::mt19937 random(5);
  for (const bool is_latest : {false, true})
    for (const bool has_ignorance : {false, true}) {
      BlockVoxels by_layer;
      for (std::size_t i = 0; i < by_layer.size(); ++i) {
        Voxel voxel = random_voxel(random, std::uint32_t(random() % 10));
        if (!has_ignorance) voxel.ignorance = 0;
        if (i % 5 == 0) voxel.observations = i % 2 == 0 ? 0 : 65535;
        by_layer.set(i, voxel);
      }
      BlockVoxels one_by_one = by_layer;
      const std::uint32_t time_ms = is_latest ? 10 : 5;
      const std::uint16_t time = by_layer.number_of_time(time_ms);
      ASSERT_EQ(one_by_one.number_of_time(time_ms), time);
      for (int z = 0; z < kBlockSide; ++z) {
        const std::uint64_t observed = std::uint64_t{random()} << 32 | random();
        PerVoxelOfLayer<float> states;
        for (float& state : states) state = float(random() % 1000) / 1000.0F;
        by_layer.observe_layer(z, observed, states, time_ms, time);
        for (std::size_t i = 0; i < states.size(); ++i)
          if ((observed >> i & 1) != 0)
            one_by_one.observe(std::size_t(z) * states.size() + i, states[i], time_ms, time);
      }
      EXPECT_TRUE(std::ranges::equal(by_layer, one_by_one)) << is_latest << has_ignorance;
    }
}

TEST(BlockVoxels, KnowWhatIsKnown) {
  BlockVoxels voxels;
  voxels.set(3, {0.5F, 10, 1});
  voxels.set(100, {0.5F, 10, 2});
  EXPECT_EQ(voxels.known_count(), 2U);
  EXPECT_TRUE(voxels.known().contains(3));
  EXPECT_EQ(voxels.known().count(), 2U);
}

}  // namespace
}  // namespace stereovox
