// Odometry that knows places again, on a camera that comes back.
#include "stereovox/odometry/place_graph.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "stereovox/odometry/odometry.h"
#include "stereovox/odometry/room_for_test.h"

namespace stereovox {
namespace {

SE3 turned(double yaw_deg) {
  Vector6d turn = Vector6d::Zero();
  turn[4] = yaw_deg * std::numbers::pi / 180.0;
  const SE3 rotation = exp(turn);
  return {rotation.rotation, {0.3 * std::sin(turn[4]), 0.0, 0.3 * std::cos(turn[4])}};
}

OdometryResult track(Odometry& odometry, const SE3& T_world_camera, int frame) {
  const Shot shot = shot_from(T_world_camera, frame);
  return odometry.track(shot.pair, shot.disparity);
}

double error_m(const SE3& T_segment_camera, double yaw_deg, double first_yaw_deg = 0.0) {
  const SE3 truth = inverse(turned(first_yaw_deg)) * turned(yaw_deg);
  return (truth.translation - T_segment_camera.translation).norm();
}

double error_deg(const SE3& T_segment_camera, double yaw_deg) {
  const SE3 truth = inverse(turned(0.0)) * turned(yaw_deg);
  return rotation_angle_rad(inverse(truth) * T_segment_camera) * 180.0 / std::numbers::pi;
}

constexpr int kStep_deg = 8, kFramesARound = 360 / kStep_deg;

TEST(PlaceGraph, TwoRoundsOnTheSpotFitTogether) {
  Odometry odometry(kCamera, {});
  double tracked_deg = 0.0, placed_deg = 0.0;
  for (int frame = 0; frame < 2 * kFramesARound; ++frame) {
    const OdometryResult result = track(odometry, turned(kStep_deg * frame), frame);
    ASSERT_EQ(result.status, OdometryStatus::tracked) << frame << ": " << result.reason;
    tracked_deg += error_deg(result.T_segment_camera, kStep_deg * frame);
  }
  const std::vector<PlacedFrame> placed = odometry.placed_frames();
  ASSERT_EQ(placed.size(), 2U * kFramesARound);
  for (int frame = 0; frame < 2 * kFramesARound; ++frame) {
    const PlacedFrame& place = placed[static_cast<std::size_t>(frame)];
    EXPECT_EQ(place.stamp_ns, ns_from_seconds(frame / kFramesPerSecond));
    placed_deg += error_deg(place.T_segment_camera, kStep_deg * frame);
  }
  EXPECT_LT(placed_deg, 0.5 * tracked_deg);
}

TEST(PlaceGraph, WithoutComparisonsThePlacesAreThoseOfTracking) {
  OdometryParams params;
  params.places.attempts = 0;
  Odometry odometry(kCamera, params);
  std::vector<SE3> tracked;
  for (int frame = 0; frame < kFramesARound; ++frame)
    tracked.push_back(track(odometry, turned(kStep_deg * frame), frame).T_segment_camera);
  const std::vector<PlacedFrame> placed = odometry.placed_frames();
  ASSERT_EQ(placed.size(), tracked.size());
  for (std::size_t i = 0; i < placed.size(); ++i)
    EXPECT_LT(log(inverse(tracked[i]) * placed[i].T_segment_camera).norm(), 1e-9) << i;
}

// The camera is carried off, sees nothing it knows, and turns back to where it was.
TEST(PlaceGraph, SegmentsThatSawTheSamePlaceBecomeOne) {
  Odometry odometry(kCamera, {});
  int frame = 0;
  for (; frame < 4; ++frame) track(odometry, turned(0.0), frame);
  std::vector<double> yaws_deg;
  for (double yaw_deg = 140.0; yaw_deg >= 0.0; yaw_deg -= 7.0) yaws_deg.push_back(yaw_deg);
  int in_new_segment = 0;
  for (const double yaw_deg : yaws_deg)
    in_new_segment += track(odometry, turned(yaw_deg), frame++).segment == 1 ? 1 : 0;
  EXPECT_GT(in_new_segment, 5);

  const std::vector<PlacedFrame> placed = odometry.placed_frames();
  ASSERT_EQ(placed.size(), 4U + yaws_deg.size() - 1) << "one frame was lost";
  for (std::size_t i = 4; i < placed.size(); ++i) {
    EXPECT_EQ(placed[i].segment, 0);
    EXPECT_LT(error_m(placed[i].T_segment_camera, yaws_deg[i - 3]), 0.03) << i;
    EXPECT_LT(error_deg(placed[i].T_segment_camera, yaws_deg[i - 3]), 0.5) << i;
  }
}

TEST(PlaceGraph, APlaceThatWouldMakeTrackingTooWrongIsNotBelieved) {
  OdometryParams params;
  params.places.max_miss_m = params.places.max_drift_share = 0.0;
  Odometry strict(kCamera, params), unlinked(kCamera, [] {
    OdometryParams none;
    none.places.attempts = 0;
    return none;
  }());
  for (int frame = 0; frame < kFramesARound + 3; ++frame) {
    track(strict, turned(kStep_deg * frame), frame);
    track(unlinked, turned(kStep_deg * frame), frame);
  }
  const auto a = strict.placed_frames(), b = unlinked.placed_frames();
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    EXPECT_EQ(a[i].T_segment_camera.translation, b[i].T_segment_camera.translation);
}

}  // namespace
}  // namespace stereovox
