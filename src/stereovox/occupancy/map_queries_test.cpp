#include "stereovox/occupancy/map_queries.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace stereovox {
namespace {

constexpr double kSize_m = 0.1;

void set(VoxelMap& map, const Eigen::Vector3i& voxel, float state, std::uint16_t observations = 5) {
  map.set(voxel, {.state = state, .last_seen_ms = 0, .observations = observations});
}

// A free corridor along x from voxel 0 to 19 that ends at an occupied voxel.
VoxelMap corridor() {
  VoxelMap map(kSize_m);
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
    const Eigen::Array3d low = voxel.cast<double>().array() * kSize_m - from.array();
    const Eigen::Array3d a = low / way.array(), b = (low + kSize_m) / way.array();
    const double in = std::max(0.0, a.min(b).maxCoeff()), out = a.max(b).minCoeff();
    if (in < out) nearest = std::min(nearest, in);
  }
  return nearest;
}

TEST(MapQueries, RandomRaysEndWhereTheNearestBoxBegins) {
  std::mt19937 random(4);
  std::uniform_int_distribution<int> place(-30, 30);
  std::normal_distribution<double> normal;
  VoxelMap map(kSize_m);
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

}  // namespace
}  // namespace stereovox
