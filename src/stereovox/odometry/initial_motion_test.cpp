#include "stereovox/odometry/initial_motion.h"

#include <gtest/gtest.h>

#include <random>

namespace stereovox {
namespace {

const RectifiedCamera kCamera400{{640, 480, 400.0, 400.0, 319.5, 239.5}, 0.12};
constexpr double kBrick_m = 0.15;

using Look = Eigen::Matrix<double, 121, 1>;

Look random_look(std::mt19937& random) {
  std::normal_distribution<double> value(0.0, 1.0);
  return Look::NullaryExpr([&] { return value(random); });
}

PatchDescriptor descriptor_of(Look look) {
  look.array() -= look.mean();
  look *= kDescriptorScale / look.norm();
  PatchDescriptor descriptor{};
  for (int i = 0; i < look.size(); ++i)
    descriptor[static_cast<std::size_t>(i)] = static_cast<std::int16_t>(std::lround(look[i]));
  return descriptor;
}

struct Landmark {
  Eigen::Vector3d p_world;
  PatchDescriptor descriptor;
};

// A brick wall whose bricks look the same, below corners that only resemble each other.
std::vector<Landmark> scene() {
  std::mt19937 random(1);
  std::vector<Landmark> landmarks;
  const PatchDescriptor brick = descriptor_of(random_look(random));
  for (int row = 0; row < 3; ++row)
    for (int column = -8; column <= 8; ++column)
      landmarks.push_back({{kBrick_m * column, 0.3 + 0.3 * row, 2.0}, brick});
  const Look common = random_look(random);
  std::uniform_real_distribution<double> across(-1.6, 1.6), down(-1.2, 0.1), ahead(1.8, 2.2);
  for (int i = 0; i < 200; ++i)
    landmarks.push_back({{across(random), down(random), ahead(random)},
                         descriptor_of(3.0 * common + random_look(random))});
  return landmarks;
}

FeatureSet features_seen_from(const SE3& T_world_camera, std::span<const Landmark> landmarks) {
  FeatureSet set;
  for (const Landmark& landmark : landmarks) {
    const Eigen::Vector3d p = inverse(T_world_camera) * landmark.p_world;
    const Eigen::Vector2d pixel = project(kCamera400.pinhole, p);
    if (pixel.x() < 0 || pixel.x() > 639 || pixel.y() < 0 || pixel.y() > 479) continue;
    set.features.push_back({pixel, kCamera400.disparity_px(p.z()), 0.2});
    set.descriptors.push_back(landmark.descriptor);
  }
  return set;
}

SE3 moved(double x_m) { return {Eigen::Quaterniond::Identity(), {x_m, 0.0, 0.0}}; }

double error_m(const InitialMotion& motion, const SE3& truth) {
  return (motion.T_reference_current.translation - truth.translation).norm();
}

InitialMotion find(const SE3& truth, const std::optional<SE3>& predicted) {
  const std::vector<Landmark> landmarks = scene();
  return find_initial_motion(kCamera400, features_seen_from(SE3{}, landmarks),
                             features_seen_from(truth, landmarks), predicted, {}, {});
}

TEST(InitialMotionTest, FollowsAGoodPrediction) {
  const InitialMotion motion = find(moved(0.1), moved(0.12));
  EXPECT_LT(error_m(motion, moved(0.1)), 0.002);
  EXPECT_GT(motion.consistent_count(), 0.9 * motion.matches);
}

TEST(InitialMotionTest, NeedsNoPrediction) {
  EXPECT_LT(error_m(find(moved(0.1), std::nullopt), moved(0.1)), 0.002);
}

// The prediction is wrong by two bricks, so that every brick finds a twin where it is expected.
TEST(InitialMotionTest, IsNotMisledByARepeatedPattern) {
  EXPECT_LT(error_m(find(moved(0.1), moved(0.1 + 2 * kBrick_m)), moved(0.1)), 0.002);
}

// Two bricks away alone: the same prediction, but nothing else is tried.
TEST(InitialMotionTest, NearAWrongPlaceItFindsTheMotionThatAPatternAllowsThere) {
  const std::vector<Landmark> landmarks = scene();
  const SE3 wrong = moved(0.1 + 2 * kBrick_m);
  const InitialMotion motion =
      find_motion_near(kCamera400, features_seen_from(SE3{}, landmarks),
                       features_seen_from(moved(0.1), landmarks), wrong, {}, {});
  EXPECT_LT(error_m(motion, wrong), 0.002);
}

}  // namespace
}  // namespace stereovox
