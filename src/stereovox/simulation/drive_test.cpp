#include "stereovox/simulation/drive.h"

#include <gmock/gmock.h>

#include <numbers>

#include "stereovox/core/error.h"
#include "stereovox/simulation/room_for_test.h"

namespace stereovox {
namespace {

constexpr DriveStyle kStyle{.speed_m_s = 0.5, .turn_rate_rad_s = 1.0, .corner_radius_m = 0.4};

std::vector<PlanarPose> poses_along(const std::vector<Waypoint>& waypoints,
                                    const DriveStyle& style = kStyle) {
  return sample(motions_of({waypoints, 0.5, 10}, style, 1), 10.0);
}

TEST(Drive, StraightWayIsDrivenAtConstantSpeed) {
  const auto poses = poses_along({{{0, 0}}, {{2, 0}}});
  ASSERT_EQ(poses.size(), 41U);  // 4 s
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_NEAR(poses[i].at_m.x(), 0.05 * static_cast<double>(i), 1e-9);
    EXPECT_NEAR(poses[i].heading_rad, 0.0, 1e-12);
  }
}

TEST(Drive, CornersAreRoundedWithinTheirReach) {
  const auto poses = poses_along({{{0, 0}}, {{3, 0}}, {{3, 3}}});
  double nearest = 10.0;
  for (const PlanarPose& pose : poses)
    nearest = std::min(nearest, (pose.at_m - Eigen::Vector2d(3, 0)).norm());
  EXPECT_NEAR(nearest, 0.4 * (std::sqrt(2.0) - 1), 0.02);
  EXPECT_NEAR((poses.back().at_m - Eigen::Vector2d(3, 3)).norm(), 0.0, 1e-9);
  EXPECT_NEAR(poses.back().heading_rad, std::numbers::pi / 2, 1e-9);
}

TEST(Drive, NeverJumpsOrTurnsFasterThanAllowed) {
  const auto poses =
      poses_along({{{0, 0}}, {{3, 0}, 90}, {{3, 3}}, {{0, 3}}, {{3, 3.1}}, {{1, 1}, -300}});
  for (std::size_t i = 1; i < poses.size(); ++i) {
    EXPECT_LE((poses[i].at_m - poses[i - 1].at_m).norm(), 0.05 + 1e-9) << i;
    EXPECT_LE(std::abs(poses[i].heading_rad - poses[i - 1].heading_rad), 0.1 + 1e-9) << i;
  }
}

TEST(Drive, TurnsOnTheSpotWhereItIsTold) {
  const auto poses = poses_along({{{0, 0}}, {{1, 0}, 360}});
  EXPECT_NEAR(poses.back().heading_rad, 2 * std::numbers::pi, 1e-9);
  EXPECT_NEAR((poses.back().at_m - Eigen::Vector2d(1, 0)).norm(), 0.0, 1e-9);
}

TEST(Drive, GoesBackByTurningRound) {
  const auto poses = poses_along({{{0, 0}}, {{2, 0}}, {{0, 0}}});
  EXPECT_NEAR(poses.back().at_m.norm(), 0.0, 1e-9);
  EXPECT_NEAR(std::abs(poses.back().heading_rad), std::numbers::pi, 1e-9);
}

TEST(Drive, JitterMovesWaypointsBySeed) {
  DriveStyle style = kStyle;
  style.jitter_m = 0.1;
  const auto a = poses_along({{{0, 0}}, {{2, 0}}}, style);
  EXPECT_GT(a[0].at_m.norm(), 0.0);
  EXPECT_LE(a[0].at_m.cwiseAbs().maxCoeff(), 0.1);
  EXPECT_EQ(a[0].at_m, poses_along({{{0, 0}}, {{2, 0}}}, style)[0].at_m);
}

TEST(CheckClearance, NamesTheSolidThatIsTooNear) {
  const World world = room_for_test();
  EXPECT_NO_THROW(check_clearance(world, {{{3.7, 2}, 0}}, {.radius_m = 0.2}, "main", "w"));
  try {
    check_clearance(world, {{{3.9, 2}, 0}}, {.radius_m = 0.2}, "main", "w.yaml");
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "w.yaml: drive 'main' comes within 0.10 m of 'box' at (3.90, 2.00)");
  }
}

}  // namespace
}  // namespace stereovox
