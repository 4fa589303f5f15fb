#include "stereovox/odometry/motion_estimate.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>

namespace stereovox {
namespace {

const RectifiedCamera kCamera500{{640, 480, 500.0, 500.0, 320.0, 240.0}, 0.12};
constexpr double kPixelSigma_px = 0.2, kDisparitySigma_px = 0.3;

SE3 some_motion() {
  Vector6d twist;
  twist << 0.2, -0.05, 0.3, 0.05, -0.1, 0.02;
  return exp(twist);
}

std::vector<Eigen::Vector3d> random_points(std::mt19937& random, int count) {
  std::uniform_real_distribution<double> side(-1.0, 1.0), depth(2.0, 6.0);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < count; ++i) points.push_back({side(random), side(random), depth(random)});
  return points;
}

// What a camera at T_reference_camera sees of the points, whose own disparity was measured with an
// error too.
std::vector<Observation> observe(std::mt19937& random, const std::vector<Eigen::Vector3d>& points,
                                 const SE3& T_reference_camera, double noise) {
  std::normal_distribution<double> normal(0.0, noise);
  std::vector<Observation> observations;
  for (const Eigen::Vector3d& p : points) {
    const Eigen::Vector3d image = project_stereo(kCamera500, p);
    const double disparity_px = image.x() - image.z() + kDisparitySigma_px * normal(random);
    const Eigen::Vector3d measured = triangulate(kCamera500, image.x(), image.y(), disparity_px);
    Eigen::Vector3d pixels = project_stereo(kCamera500, inverse(T_reference_camera) * p);
    for (double& pixel : pixels) pixel += kPixelSigma_px * normal(random);
    observations.push_back(
        {measured, -measured / disparity_px, kDisparitySigma_px, pixels, kPixelSigma_px});
  }
  return observations;
}

TEST(MotionEstimate, ClosedFormIsExactWithoutNoise) {
  std::mt19937 random(1);
  const std::vector<Eigen::Vector3d> from = random_points(random, 10);
  std::vector<Eigen::Vector3d> to;
  for (const Eigen::Vector3d& p : from) to.push_back(some_motion() * p);
  const std::vector<double> weights = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
  const SE3 found = closed_form_motion(from, to, weights);
  EXPECT_LT(log(inverse(some_motion()) * found).norm(), 1e-12);
}

TEST(MotionEstimate, ClosedFormOfPointsInAPlaneIsNoMirrorImage) {
  const std::vector<Eigen::Vector3d> from = {{0, 0, 2}, {1, 0, 2}, {0, 1, 2}, {1, 1, 2}};
  for (int i = 0; i < 20; ++i) {
    Vector6d twist;
    twist << 0.1, 0.2, 0.3, 0.3 * i, 0.1 * i, -0.2 * i;
    std::vector<Eigen::Vector3d> to;
    for (const Eigen::Vector3d& p : from) to.push_back(exp(twist) * p);
    const SE3 found = closed_form_motion(from, to, std::vector<double>(4, 1.0));
    EXPECT_LT(log(inverse(exp(twist)) * found).norm(), 1e-9) << "rotation " << i;
  }
}

TEST(MotionEstimate, RefinementIsExactWithoutNoiseAndFindsTheOutliers) {
  std::mt19937 random(2);
  std::vector<Observation> observations =
      observe(random, random_points(random, 60), some_motion(), 0.0);
  for (std::size_t i = 0; i < 15; ++i) observations[i].pixels.x() += 20.0 + static_cast<double>(i);
  const MotionEstimate estimate = refine_motion(kCamera500, observations, SE3{}, {});
  EXPECT_LT(log(inverse(some_motion()) * estimate.T_reference_camera).norm(), 1e-6);
  EXPECT_EQ(estimate.inliers, 45);
  EXPECT_FALSE(estimate.is_inlier[0]);
  EXPECT_TRUE(estimate.is_inlier[59]);
  EXPECT_LT(estimate.rms_px, 1e-4);
}

TEST(MotionEstimate, CovarianceIsThatOfTheErrorsOverManyTrials) {
  constexpr int trials = 200;
  double sum = 0.0;
  for (unsigned seed = 0; seed < trials; ++seed) {
    std::mt19937 random(seed);
    const auto observations = observe(random, random_points(random, 80), some_motion(), 1.0);
    const MotionEstimate estimate = refine_motion(kCamera500, observations, SE3{}, {});
    const Vector6d error = log(inverse(estimate.T_reference_camera) * some_motion());
    sum += error.dot(estimate.covariance.inverse() * error);
  }
  // Chi-square with 6 degrees of freedom: the mean over the trials is 6 +- sqrt(12 / trials). The
  // robust weights cost a few per cent.
  EXPECT_NEAR(sum / trials, 6.0, 4.0 * std::sqrt(12.0 / trials));
}

TEST(MotionEstimate, TooFewPointsOrAllInOneDirectionGiveAnInfiniteCovariance) {
  std::mt19937 random(3);
  const auto two = observe(random, random_points(random, 2), some_motion(), 0.0);
  EXPECT_TRUE(std::isinf(refine_motion(kCamera500, two, SE3{}, {}).covariance(0, 0)));
  const auto same = observe(random, std::vector<Eigen::Vector3d>(9, {0, 0, 3}), SE3{}, 0.0);
  EXPECT_TRUE(std::isinf(refine_motion(kCamera500, same, SE3{}, {}).covariance(0, 0)));
}

TEST(MotionEstimate, SameMotionWhenTheReferenceFrameIsAnother) {
  std::mt19937 random(4);
  const auto observations = observe(random, random_points(random, 50), some_motion(), 1.0);
  Vector6d twist;
  twist << 3.0, -2.0, 1.0, 0.5, 1.0, -0.4;
  const SE3 T_world_reference = exp(twist);
  std::vector<Observation> in_world = observations;
  for (Observation& o : in_world) {
    o.p_reference = T_world_reference * o.p_reference;
    o.dp_ddisparity = T_world_reference.rotation * o.dp_ddisparity;
  }
  const MotionEstimate a = refine_motion(kCamera500, observations, SE3{}, {});
  const MotionEstimate b = refine_motion(kCamera500, in_world, T_world_reference, {});
  EXPECT_LT(log(inverse(T_world_reference * a.T_reference_camera) * b.T_reference_camera).norm(),
            1e-8);
  EXPECT_LT((a.covariance - b.covariance).norm(), 1e-6 * a.covariance.norm());
}

}  // namespace
}  // namespace stereovox
