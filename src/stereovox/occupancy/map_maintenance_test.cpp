#include "stereovox/occupancy/map_maintenance.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <sstream>

#include "stereovox/core/error.h"
#include "stereovox/occupancy/integrate.h"
#include "stereovox/occupancy/map_bytes_for_test.h"
#include "stereovox/occupancy/scene_for_test.h"
#include "stereovox/occupancy/voxel_map_file.h"

namespace stereovox {
namespace {

constexpr double kSize_m = 0.1;

VoxelMap scattered_map(unsigned seed, int voxels) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> place(-30, 30);
  std::uniform_real_distribution<float> state(0.0F, 1.0F);
  VoxelMap map(kSize_m);
  map.epoch_ns = 0;
  for (int i = 0; i < voxels; ++i)
    map.set({place(random), place(random), place(random)},
            {state(random), std::uint32_t(random() % 100'000), std::uint16_t(1 + random() % 50)});
  return map;
}

bool is_inside(const VoxelBounds& box, const Eigen::Vector3i& v) {
  return (v.array() >= box.min.array()).all() && (v.array() <= box.max.array()).all();
}

constexpr int kEdge = 31;
template <class Visit>
void for_each_place(Visit visit) {
  for (int x = -kEdge; x <= kEdge; ++x)
    for (int y = -kEdge; y <= kEdge; ++y)
      for (int z = -kEdge; z <= kEdge; ++z) visit(Eigen::Vector3i(x, y, z));
}

TEST(MapMaintenance, ClearingABoxForgetsItAndNothingElse) {
  const VoxelBounds box{{-10, -3, 0}, {12, 7, 15}};
  const VoxelMap before = scattered_map(1, 20'000);
  VoxelMap map = before;
  const ChangeStamp stamp = map.change_stamp();
  clear_box(box, map);
  for_each_place([&](const Eigen::Vector3i& v) {
    EXPECT_EQ(map.at(v), is_inside(box, v) ? Voxel{} : before.at(v));
  });
  EXPECT_EQ(map.find_block({0, 0, 0}), nullptr);  // lies in the box
  for (const Eigen::Vector3i& block : map.blocks_changed_since(stamp))
    EXPECT_LE(block.cwiseAbs().maxCoeff(), 2);
}

TEST(MapMaintenance, CroppingKeepsTheBoxOnly) {
  const VoxelBounds box{{-10, -3, 0}, {12, 7, 15}};
  const VoxelMap before = scattered_map(2, 20'000);
  VoxelMap map = before;
  crop(box, map);
  for_each_place([&](const Eigen::Vector3i& v) {
    EXPECT_EQ(map.at(v), is_inside(box, v) ? before.at(v) : Voxel{});
  });
  EXPECT_EQ(map.find_block({3, 3, 3}), nullptr);
}

TEST(MapMaintenance, MergingWithAnEmptyMapMovesTheVoxels) {
  const VoxelMap other = scattered_map(3, 3000);
  const SE3 quarter_turn{
      Eigen::Quaterniond(Eigen::AngleAxisd(0.5 * std::numbers::pi, Eigen::Vector3d::UnitZ())),
      {1.0, 0.0, 0.3}};
  VoxelMap map(kSize_m);
  merge(other, quarter_turn, map);
  EXPECT_EQ(map.known_voxel_count(), other.known_voxel_count());
  // (x, y, z) goes to (-y, x, z): cell [x, x + 1) to (-y - 1), then 10 and 3 voxels on.
  for_each_place([&](const Eigen::Vector3i& v) {
    EXPECT_EQ(map.at({-v.y() - 1 + 10, v.x(), v.z() + 3}), other.at(v));
  });
  VoxelMap back(kSize_m);
  merge(map, inverse(quarter_turn), back);
  EXPECT_TRUE(bytes_of(back) == bytes_of(other));
}

TEST(MapMaintenance, AMapThatWouldLeaveTheLatticeIsNotMerged) {
  const VoxelMap other = scattered_map(3, 100);
  VoxelMap map = scattered_map(4, 100);
  const std::string before = bytes_of(map);
  for (const double x_m : {1e6, -1e300, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW(merge(other, {Eigen::Quaterniond::Identity(), {x_m, 0, 0}}, map), Error) << x_m;
  EXPECT_TRUE(bytes_of(map) == before);
}

TEST(MapMaintenance, MergedVoxelsWeighTheirObservations) {
  VoxelMap map(kSize_m), other(kSize_m), coarser(0.2);
  map.epoch_ns = 10'000'000'000;
  other.epoch_ns = 12'000'000'000;
  map.set({1, 1, 1}, {0.9F, 5000, 3});
  other.set({1, 1, 1}, {0.1F, 4000, 1});
  other.set({2, 1, 1}, {0.3F, 100, 65'535});
  map.set({2, 1, 1}, {0.3F, 100, 10});
  merge(other, SE3{}, map);
  EXPECT_NEAR(map.at({1, 1, 1}).state, 0.7, 1e-6);
  EXPECT_EQ(map.at({1, 1, 1}).last_seen_ms, 6000U);
  EXPECT_EQ(map.at({1, 1, 1}).observations, 4);
  EXPECT_EQ(map.at({2, 1, 1}).observations, 65'535);
  EXPECT_THROW(merge(coarser, SE3{}, map), Error);
}

TEST(MapMaintenance, ACoarseVoxelIsAsOccupiedAsTheMostOccupiedInIt) {
  const VoxelMap map = scattered_map(4, 20'000);
  for (const int factor : {2, 8}) {
    const VoxelMap coarse = downsampled(map, factor);
    EXPECT_EQ(coarse.voxel_size_m(), kSize_m * factor);
    VoxelMap expected(kSize_m * factor);
    std::size_t known = 0;
    for (int x = -32 / factor; x < 32 / factor; ++x)
      for (int y = -32 / factor; y < 32 / factor; ++y)
        for (int z = -32 / factor; z < 32 / factor; ++z) {
          float most = -1.0F;
          for (int i = 0; i < factor * factor * factor; ++i) {
            const Voxel fine = map.at({x * factor + i % factor, y * factor + i / factor % factor,
                                       z * factor + i / factor / factor});
            if (is_known(fine)) most = std::max(most, fine.state);
          }
          const Voxel voxel = coarse.at({x, y, z});
          known += is_known(voxel) ? 1U : 0U;
          ASSERT_EQ(is_known(voxel), most >= 0.0F);
          if (!is_known(voxel)) continue;
          ASSERT_EQ(voxel.state, most);
        }
    EXPECT_EQ(known, coarse.known_voxel_count());
  }
  EXPECT_THROW(downsampled(map, 3), std::logic_error);
  EXPECT_THROW(downsampled(map, 256), Error);
}

TEST(MapMaintenance, WhatWasNotSeenForLongFades) {
  VoxelMap map(kSize_m);
  map.set({0, 0, 0}, {1.0F, 0, 9});
  map.set({1, 0, 0}, {0.0F, 50'000, 9});
  map.set({2, 0, 0}, {0.8F, 100'000, 9});
  map.set({50, 0, 0}, {0.8F, 200'000, 9});
  const ChangeStamp stamp = map.change_stamp();
  decay({.time_constant_s = 50.0, .forget_below = 0.1}, 100'000, map);
  EXPECT_FALSE(is_known(map.at({0, 0, 0})));  // 0.5 exp(-2) is less than 0.1
  EXPECT_NEAR(map.at({1, 0, 0}).state, 0.5 - 0.5 * std::exp(-1.0), 1e-6);
  EXPECT_EQ(map.at({1, 0, 0}).last_seen_ms, 50'000U);
  EXPECT_EQ(map.at({2, 0, 0}), (Voxel{0.8F, 100'000, 9}));
  EXPECT_EQ(map.at({50, 0, 0}), (Voxel{0.8F, 200'000, 9}));  // from the future
  EXPECT_THAT(map.blocks_changed_since(stamp), testing::ElementsAre(Eigen::Vector3i(0, 0, 0)));
}

// Sees a wall at 2.1 m, then for some frames a thing at 1.3 m before it, then the wall again.
VoxelMap after_a_visitor(const OccupancyParams& params, int frames_with, int frames_after) {
  VoxelMap map(params.voxel_size_m);
  int frame = 0;
  const auto see = [&](const DisparityImage& image, int frames) {
    for (int i = 0; i < frames; ++i)
      integrate(image, scene::camera(), scene::level_pose(0, {0.05, 0.1, 1.1}),
                frame++ * scene::kSecond_ns / 5, params, 1, map);
  };
  DisparityImage visited = scene::wall_at(2.1);
  visited.disparity_px(cv::Rect(20, 8, 24, 32)).setTo(scene::camera().disparity_px(1.3));
  see(scene::wall_at(2.1), 3);
  see(visited, frames_with);
  see(scene::wall_at(2.1), frames_after);
  return map;
}

TEST(MovingObjects, DisappearWhenTheSpaceBehindThemIsSeenAgain) {
  for (const char* rule :
       {"saturating", "log_odds", "continuous_log_odds", "dempster_shafer", "frequency"})
    for (const char* set : {"raycast", "projected"}) {
      SCOPED_TRACE(std::string(rule) + " " + set);
      OccupancyParams params = scene::params(OccupancyPreset::corrected);
      apply_settings({{"update.type", rule}, {"observed_set", set}}, params);
      // 1.3 and 2.1 m ahead; a rule may draw a surface one voxel behind its front.
      const Eigen::Vector3i visitor(6, 0, 5), wall(10, 0, 5), behind(11, 0, 5);
      const VoxelMap visited = after_a_visitor(params, 8, 0);
      EXPECT_GT(std::max(visited.at(visitor).state, visited.at({7, 0, 5}).state), 0.5F);
      const VoxelMap map = after_a_visitor(params, 8, 40);
      for (const int x : {5, 6, 7}) EXPECT_LT(map.at({x, 0, 5}).state, 0.5F);
      EXPECT_GT(std::max(map.at(wall).state, map.at(behind).state), 0.5F);
    }
}

}  // namespace
}  // namespace stereovox
