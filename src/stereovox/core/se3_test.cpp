#include "stereovox/core/se3.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace stereovox {
namespace {

Vector6d random_twist(std::mt19937& random, double scale) {
  std::uniform_real_distribution<double> uniform(-scale, scale);
  Vector6d twist;
  for (double& t : twist) t = uniform(random);
  return twist;
}

TEST(SE3, LogInvertsExpFromTinyToLargeRotations) {
  std::mt19937 random(1);
  for (const double scale : {1e-12, 1e-7, 1e-5, 1e-3, 0.1, 1.5})
    for (int i = 0; i < 20; ++i) {
      const Vector6d twist = random_twist(random, scale);
      EXPECT_LT((log(exp(twist)) - twist).norm(), 1e-9 * scale + 1e-15) << twist.transpose();
    }
}

TEST(SE3, ExpOfAScrewMovesAlongItsAxis) {
  Vector6d twist;
  twist << 0, 0, 2, 0, 0, M_PI / 2;
  EXPECT_LT((exp(twist) * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(0, 1, 2)).norm(), 1e-12);
}

TEST(SE3, InverseAndInterpolationAreConsistent) {
  std::mt19937 random(2);
  const SE3 a = exp(random_twist(random, 1.0)), b = exp(random_twist(random, 1.0));
  EXPECT_LT(log(a * inverse(a)).norm(), 1e-12);
  EXPECT_LT(log(inverse(b) * interpolate(a, b, 1.0)).norm(), 1e-9);
  const SE3 middle = interpolate(a, b, 0.5);
  EXPECT_LT((log(inverse(a) * middle) - log(inverse(middle) * b)).norm(), 1e-9);
}

TEST(SE3, NearestRotationMeasuresHowFarAMatrixIsFromOne) {
  const Eigen::Matrix3d R = exp(Vector6d::Constant(0.3)).rotation.toRotationMatrix();
  EXPECT_LT(nearest_rotation(R).residual, 1e-12);
  EXPECT_NEAR(nearest_rotation(1.1 * R).residual, 0.21, 1e-9);
  EXPECT_TRUE(std::isinf(nearest_rotation(-R).residual));
}

}  // namespace
}  // namespace stereovox
