#include "stereovox/core/se3.h"

#include <Eigen/SVD>
#include <cmath>
#include <limits>

namespace stereovox {
namespace {

// Below this angle the series replaces the closed forms, whose relative error it then undercuts.
constexpr double kSmallAngle_rad = 1e-5;

Eigen::Vector3d rotation_vector(const Eigen::Quaterniond& q) {
  const Eigen::Quaterniond positive = q.w() < 0.0 ? Eigen::Quaterniond(-q.coeffs()) : q;
  const double sine = positive.vec().norm();
  const double angle_rad = 2.0 * std::atan2(sine, positive.w());
  return sine < 0.5 * kSmallAngle_rad ? Eigen::Vector3d(2.0 * positive.vec())
                                      : Eigen::Vector3d(positive.vec() * (angle_rad / sine));
}

// Left Jacobian of SO(3): the translation of exp((v, w)) is V(w) v.
Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& w) {
  const double angle_rad = w.norm();
  const Eigen::Matrix3d W = skew(w);
  if (angle_rad < kSmallAngle_rad) return Eigen::Matrix3d::Identity() + 0.5 * W + W * W / 6.0;
  const double angle2 = angle_rad * angle_rad;
  return Eigen::Matrix3d::Identity() + (1.0 - std::cos(angle_rad)) / angle2 * W +
         (angle_rad - std::sin(angle_rad)) / (angle2 * angle_rad) * W * W;
}

}  // namespace

SE3 inverse(const SE3& T) {
  const Eigen::Quaterniond rotation = T.rotation.conjugate();
  return {rotation, -(rotation * T.translation)};
}

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

SE3 exp(const Vector6d& twist) {
  const Eigen::Vector3d w = twist.tail<3>();
  const double half_angle_rad = 0.5 * w.norm();
  const double sine_ratio = half_angle_rad < kSmallAngle_rad
                                ? 0.5 - half_angle_rad * half_angle_rad / 12.0
                                : 0.5 * std::sin(half_angle_rad) / half_angle_rad;
  Eigen::Quaterniond rotation;
  rotation.w() = std::cos(half_angle_rad);
  rotation.vec() = sine_ratio * w;
  return {rotation.normalized(), left_jacobian(w) * twist.head<3>()};
}

Vector6d log(const SE3& T) {
  Vector6d twist;
  const Eigen::Vector3d w = rotation_vector(T.rotation);
  twist.head<3>() = left_jacobian(w).partialPivLu().solve(T.translation);
  twist.tail<3>() = w;
  return twist;
}

SE3 interpolate(const SE3& a, const SE3& b, double fraction) {
  return a * exp(fraction * log(inverse(a) * b));
}

double rotation_angle_rad(const SE3& T) { return rotation_vector(T.rotation).norm(); }

bool is_finite(const SE3& T) {
  return T.rotation.coeffs().allFinite() && T.translation.allFinite();
}

NearestRotation nearest_rotation(const Eigen::Matrix3d& matrix) {
  if (!matrix.allFinite() || matrix.determinant() <= 0.0)
    return {Eigen::Quaterniond::Identity(), std::numeric_limits<double>::infinity()};
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d R = svd.matrixU() * svd.matrixV().transpose();
  const Eigen::Matrix3d error = matrix * matrix.transpose() - Eigen::Matrix3d::Identity();
  return {Eigen::Quaterniond(R).normalized(), error.cwiseAbs().maxCoeff()};
}

}  // namespace stereovox
