#include "stereovox/occupancy/distance_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace stereovox {
namespace {

constexpr double kSize_m = 0.1;

// The plain twin: looks at every occupied voxel of the map.
std::uint16_t brute_force(const VoxelMap& map, const DistanceMapParams& params,
                          const Eigen::Vector3i& voxel) {
  const MapQueries queries(map, params.query);
  const double limit = params.max_distance_m / kSize_m;
  std::int64_t nearest = std::numeric_limits<std::int64_t>::max();
  map.for_each_block([&](const VoxelBlock& block) {
    for (int i = 0; i < kVoxelsPerBlock; ++i) {
      if (queries.state_of(block.voxels[std::size_t(i)]) != VoxelState::occupied) continue;
      Eigen::Vector3i apart = voxel_at(block.index, i) - voxel;
      const double z_m = (voxel_at(block.index, i).z() + 0.5) * kSize_m;
      if (params.plane && (z_m < params.plane->low_m || z_m > params.plane->high_m)) continue;
      if (params.plane) apart.z() = 0;
      nearest = std::min<std::int64_t>(nearest, apart.squaredNorm());
    }
  });
  return double(nearest) <= limit * limit ? std::uint16_t(nearest) : TruncatedDistances::kBeyond;
}

void scatter(std::mt19937& random, int count, VoxelMap& map) {
  std::uniform_int_distribution<int> place(-40, 40), height(-12, 12);
  for (int i = 0; i < count; ++i)
    map.set({place(random), place(random), height(random)},
            {.state = random() % 2 == 0 ? 0.9F : 0.1F, .observations = 1});
}

void expect_equal(const DistanceMap& field, const VoxelMap& map, const DistanceMapParams& params,
                  std::mt19937& random) {
  std::uniform_int_distribution<int> place(-60, 60);
  for (int i = 0; i < 400; ++i) {
    const Eigen::Vector3i voxel(place(random), place(random), place(random) / 2);
    ASSERT_EQ(field.squared_voxels(voxel), brute_force(map, params, voxel)) << voxel.transpose();
  }
}

std::vector<DistanceMapParams> kinds() {
  return {{.max_distance_m = 1.25},
          {.max_distance_m = 0.1},
          {.max_distance_m = 1.95, .plane = DistanceMapParams::Band{-0.46, 0.71}}};
}

TEST(DistanceMap, EqualsItsPlainTwinAfterEveryChange) {
  for (const DistanceMapParams& params : kinds()) {
    std::mt19937 random(5);
    VoxelMap map(kSize_m);
    DistanceMap field(kSize_m, params);
    for (int round = 0; round < 6; ++round) {
      scatter(random, round == 0 ? 150 : 6, map);
      if (round == 3) map.erase_block({0, 0, 0});
      if (round == 4) scatter(random, 400, map);
      field.update(map, 1 + round % 3);
      expect_equal(field, map, params, random);
    }
  }
}

TEST(DistanceMap, AnUpdateGivesWhatAFreshFieldGives) {
  for (const DistanceMapParams& params : kinds()) {
    std::mt19937 random(6);
    VoxelMap map(kSize_m);
    DistanceMap grown(kSize_m, params);
    for (int round = 0; round < 5; ++round) {
      scatter(random, 60, map);
      grown.update(map, 2);
    }
    DistanceMap fresh(kSize_m, params);
    fresh.update(map, 1);
    for (int x = -60; x < 60; ++x)
      for (int y = -60; y < 60; ++y)
        ASSERT_EQ(grown.squared_voxels({x, y, 3}), fresh.squared_voxels({x, y, 3}));
  }
}

TEST(DistanceMap, GivesMetresAndNeverMoreThanItsLimit) {
  VoxelMap map(kSize_m);
  map.set({0, 0, 0}, {.state = 0.9F, .observations = 1});
  DistanceMap field(kSize_m, {.max_distance_m = 1.0});
  EXPECT_EQ(field.distance_m({0.05, 0.05, 0.05}), 1.0);
  field.update(map, 1);
  EXPECT_EQ(field.distance_m({0.05, 0.05, 0.05}), 0.0);
  EXPECT_NEAR(field.distance_m({0.35, 0.45, 0.05}), 0.5, 1e-12);
  EXPECT_EQ(field.distance_m({5, 0, 0}), 1.0);
  EXPECT_EQ(field.distance_m({1e7, 0, 0}), 1.0);
}

TEST(DistanceMap, RefusesLimitsItCannotKeep) {
  EXPECT_THROW(DistanceMap(0.1, {.max_distance_m = 0.0}), std::logic_error);
  EXPECT_THROW(DistanceMap(0.1, {.max_distance_m = 10.5}), std::logic_error);
}

}  // namespace
}  // namespace stereovox
