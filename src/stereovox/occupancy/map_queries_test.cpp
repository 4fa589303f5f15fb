#include "stereovox/occupancy/map_queries.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace stereovox {
namespace {

constexpr double kQuerySize_m = 0.1;

void set(VoxelMap& map, const Eigen::Vector3i& voxel, float state, std::uint16_t observations = 5) {
  map.set(voxel, {.state = state, .last_seen_ms = 0, .observations = observations});
}

// A free corridor along x from voxel 0 to 19 that ends at an occupied voxel.
VoxelMap corridor() {
  VoxelMap map(kQuerySize_m);
  for (int x = 0; x < 20; ++x) set(map, {x, 0, 0}, 0.0F);
  set(map, {20, 0, 0}, 0.9F);
  return map;
}

const Eigen::Vector3d kStart(0.05, 0.05, 0.05), kAlongX(3, 0, 0);

TEST(MapQueries, TellTheStatesApart) {
  const VoxelMap map = corridor();
  const MapQueries queries(map);
  const std::vector<Eigen::Vector3d> points = {{0.05, 0.05, 0.05}, {2.05, 0.05, 0.05}, {9, 9, 9}};
  const std::vector<VoxelState> states = {VoxelState::free, VoxelState::occupied,
                                          VoxelState::unknown};
  EXPECT_EQ(queries.states_at(points), states);
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(queries.state_at(points[i]), states[i]);
}

TEST(MapQueries, ManyStatesAskedAtOnceAreThoseOfEachAlone) {
  std::mt19937 random(9);
  std::uniform_int_distribution<int> place(-9, 9), count(1, 9);
  std::uniform_real_distribution<float> state(0.0F, 1.0F);
  VoxelMap map(kQuerySize_m);
  for (int i = 0; i < 5000; ++i)
    set(map, {place(random), place(random), place(random)}, state(random),
        static_cast<std::uint16_t>(count(random)));
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 1003; ++i)
    points.emplace_back(0.13 * place(random), 0.13 * place(random), 0.13 * place(random));
  points.emplace_back(1e9, 0, 0);  // beyond the lattice
  const MapQueries queries(map, {.threshold = 0.6F, .min_observations = 3});
  const std::vector<VoxelState> states = queries.states_at(points);
  ASSERT_EQ(states.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Voxel voxel = map.at(voxel_index_of(kQuerySize_m, points[i]));
    const VoxelState expected = voxel.observations < 3 ? VoxelState::unknown
                                : voxel.state > 0.6F   ? VoxelState::occupied
                                                       : VoxelState::free;
    EXPECT_EQ(states[i], expected);
    EXPECT_EQ(queries.state_at(points[i]), expected);
  }
  for (const VoxelState each : {VoxelState::unknown, VoxelState::free, VoxelState::occupied})
    EXPECT_GT(std::ranges::count(states, each), 20);
}

TEST(MapQueries, VoxelsObservedTooSeldomAreUnknown) {
  const VoxelMap map = corridor();
  EXPECT_EQ(MapQueries(map, {.min_observations = 6}).state_at({2.05, 0.05, 0.05}),
            VoxelState::unknown);
}

TEST(MapQueries, ARayEndsAtTheFirstOccupiedVoxel) {
  const VoxelMap map = corridor();
  const auto hit = MapQueries(map).cast_ray(kStart, kAlongX, 5.0);
  ASSERT_TRUE(hit.has_value());
  EXPECT_EQ(hit->voxel, Eigen::Vector3i(20, 0, 0));
  EXPECT_NEAR(hit->distance_m, 1.95, 1e-12);
  EXPECT_FALSE(MapQueries(map).cast_ray(kStart, kAlongX, 1.9).has_value());
  EXPECT_FALSE(MapQueries(map).cast_ray(kStart, -kAlongX, 5.0).has_value());
}

TEST(MapQueries, UnknownSpaceStopsARayWhenItShall) {
  const VoxelMap map = corridor();
  const MapQueries careful(map, {.unknown = UnknownSpace::is_occupied});
  const auto hit = careful.cast_ray(kStart, -kAlongX, 5.0);
  ASSERT_TRUE(hit.has_value());
  EXPECT_EQ(hit->voxel, Eigen::Vector3i(-1, 0, 0));
  EXPECT_EQ(hit->state, VoxelState::unknown);
  EXPECT_EQ(careful.cast_ray(kStart, kAlongX, 5.0)->state, VoxelState::occupied);
}

TEST(MapQueries, ARayWithoutDirectionIsAProgrammingError) {
  const VoxelMap map = corridor();
  EXPECT_THROW(MapQueries(map).cast_ray(kStart, {0, 0, 0}, 1.0), std::logic_error);
  EXPECT_THROW(MapQueries(map).cast_ray(kStart, {NAN, 0, 0}, 1.0), std::logic_error);
}

// Every voxel that a ray could meet, tested as a box.
double nearest_by_boxes(const std::vector<Eigen::Vector3i>& occupied, const Eigen::Vector3d& from,
                        const Eigen::Vector3d& way) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3i& voxel : occupied) {
    const Eigen::Array3d low = voxel.cast<double>().array() * kQuerySize_m - from.array();
    const Eigen::Array3d a = low / way.array(), b = (low + kQuerySize_m) / way.array();
    const double in = std::max(0.0, a.min(b).maxCoeff()), out = a.max(b).minCoeff();
    if (in < out) nearest = std::min(nearest, in);
  }
  return nearest;
}

TEST(MapQueries, RandomRaysEndWhereTheNearestBoxBegins) {
  std::mt19937 random(4);
  std::uniform_int_distribution<int> place(-30, 30);
  std::normal_distribution<double> normal;
  VoxelMap map(kQuerySize_m);
  std::vector<Eigen::Vector3i> occupied;
  for (int i = 0; i < 1500; ++i) {
    occupied.emplace_back(place(random), place(random), place(random));
    set(map, occupied.back(), 1.0F);
  }
  int hits = 0;
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d way =
        Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
    const auto hit = MapQueries(map).cast_ray({0.013, 0.027, 0.031}, way, 4.0);
    const double expected = nearest_by_boxes(occupied, {0.013, 0.027, 0.031}, way);
    ASSERT_EQ(hit.has_value(), expected <= 4.0);
    if (!hit) continue;
    EXPECT_NEAR(hit->distance_m, expected, 1e-9);
    ++hits;
  }
  EXPECT_GT(hits, 50);
  EXPECT_LT(hits, 500);
}

TEST(MapQueries, ABodyCollidesWithWhatItTouches) {
  const VoxelMap map = corridor();  // occupied from (2.0, 0, 0) to (2.1, 0.1, 0.1)
  const MapQueries queries(map);
  EXPECT_TRUE(queries.box_collides({1.0, 0, 0}, {2.01, 0.05, 0.05}));
  EXPECT_FALSE(queries.box_collides({1.0, 0, 0}, {1.99, 0.05, 0.05}));
  EXPECT_FALSE(queries.box_collides({2.11, 0, 0}, {3.0, 0.05, 0.05}));
  EXPECT_TRUE(queries.ball_collides({1.75, 0.05, 0.05}, 0.26));
  EXPECT_FALSE(queries.ball_collides({1.75, 0.05, 0.05}, 0.24));
  // Beside the corner, within the bounding box of the ball but not within the ball.
  EXPECT_FALSE(queries.ball_collides({1.8, -0.2, 0.05}, 0.25));
  EXPECT_TRUE(queries.ball_collides({1.8, -0.2, 0.05}, 0.29));
}

TEST(MapQueries, ABodyCollidesWithUnknownSpaceWhenItShall) {
  const VoxelMap map = corridor();
  const MapQueries careful(map, {.unknown = UnknownSpace::is_occupied});
  EXPECT_FALSE(careful.box_collides({0.31, 0.02, 0.02}, {0.69, 0.08, 0.08}));
  EXPECT_TRUE(careful.box_collides({0.31, 0.02, 0.02}, {0.69, 0.12, 0.08}));
}

VoxelMap scattered_map(std::mt19937& random, int voxels) {
  VoxelMap map(kQuerySize_m);
  std::uniform_int_distribution<int> place(-25, 25);
  for (int i = 0; i < voxels; ++i)
    set(map, {place(random), place(random), place(random)}, random() % 3 == 0 ? 0.9F : 0.1F);
  return map;
}

// The plain twin: looks at every voxel.
std::optional<Obstacle> nearest_by_force(const VoxelMap& map, const Eigen::Vector3d& p,
                                         double range_m) {
  std::optional<Obstacle> nearest;
  for (const VoxelBlock* block : map.sorted_blocks())
    for (int i = 0; i < kVoxelsPerBlock; ++i) {
      const Eigen::Vector3i voxel = voxel_at(block->index, i);
      if (MapQueries(map).state_of(map.at(voxel)) != VoxelState::occupied) continue;
      const Eigen::Vector3d low = voxel.cast<double>() * kQuerySize_m;
      const Eigen::Vector3d high = (low.array() + kQuerySize_m).matrix();
      const double distance_m = (p - p.cwiseMax(low).cwiseMin(high)).norm();
      if (distance_m > range_m) continue;
      if (!nearest || distance_m < nearest->distance_m ||
          (distance_m == nearest->distance_m && LatticeOrder{}(voxel, nearest->voxel)))
        nearest = Obstacle{voxel, distance_m};
    }
  return nearest;
}

TEST(MapQueries, TheNearestObstacleIsWhatATwinFindsThatLooksAtAll) {
  std::mt19937 random(12);
  std::uniform_real_distribution<double> place(-4.0, 4.0), range(0.0, 3.0);
  int found = 0;
  for (const int voxels : {5, 60, 2000}) {
    const VoxelMap map = scattered_map(random, voxels);
    const MapQueries queries(map);
    for (int trial = 0; trial < 90; ++trial) {
      Eigen::Vector3d p(place(random), place(random), place(random));
      if (trial % 4 == 0) p = (p * 10.0).array().round() / 10.0;  // on faces: many are as near
      const double range_m = range(random);
      const auto nearest = queries.nearest_obstacle(p, range_m);
      const auto expected = nearest_by_force(map, p, range_m);
      ASSERT_EQ(nearest.has_value(), expected.has_value());
      if (!nearest) continue;
      ++found;
      EXPECT_NEAR(nearest->distance_m, expected->distance_m, 1e-12);
      if (trial % 4 != 0) {
        EXPECT_EQ(nearest->voxel, expected->voxel);
      }
    }
  }
  EXPECT_GT(found, 80);
}

TEST(MapQueries, TheFrontierIsWhereFreeSpaceMeetsTheUnknown) {
  std::mt19937 random(13);
  const VoxelMap map = scattered_map(random, 60'000);
  const MapQueries queries(map);
  const VoxelBounds box{{-20, -30, -9}, {20, 11, 30}};
  std::vector<Eigen::Vector3i> expected;
  Eigen::Vector3i v;
  for (v.x() = box.min.x(); v.x() <= box.max.x(); ++v.x())
    for (v.y() = box.min.y(); v.y() <= box.max.y(); ++v.y())
      for (v.z() = box.min.z(); v.z() <= box.max.z(); ++v.z()) {
        bool meets = false;
        for (int axis = 0; axis < 3; ++axis)
          for (const int side : {-1, 1})
            meets |= !is_known(map.at(v + side * Eigen::Vector3i::Unit(axis)));
        if (meets && queries.state_of(map.at(v)) == VoxelState::free) expected.push_back(v);
      }
  EXPECT_GT(expected.size(), 1000U);
  EXPECT_EQ(frontier_voxels(map, {}, box), expected);
}

}  // namespace
}  // namespace stereovox
