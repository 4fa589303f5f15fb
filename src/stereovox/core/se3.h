// Rigid motions. `T_a_b` takes coordinates from frame b to frame a: p_a = T_a_b * p_b.
//
//   const SE3 T_world_right = T_world_left * T_left_right;
//   const SE3 T_left_world = inverse(T_world_left);
//
// A twist is (translation rate, rotation rate) = (v, w), in that order, everywhere.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace stereovox {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

struct SE3 {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  // unit length
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  Eigen::Vector3d operator*(const Eigen::Vector3d& p) const { return rotation * p + translation; }
  SE3 operator*(const SE3& other) const {
    return {(rotation * other.rotation).normalized(), *this * other.translation};
  }
};

SE3 inverse(const SE3& T);

// The matrix [v]_x with [v]_x u = v x u.
Eigen::Matrix3d skew(const Eigen::Vector3d& v);

// Exponential and logarithm of SE(3); exact inverses for rotations below pi.
SE3 exp(const Vector6d& twist);
Vector6d log(const SE3& T);

// On the screw motion from `a` (fraction 0) to `b` (fraction 1).
SE3 interpolate(const SE3& a, const SE3& b, double fraction);

// Angle of the rotation, in [0, pi].
double rotation_angle_rad(const SE3& T);

bool is_finite(const SE3& T);

// Turns a 3x3 matrix into the nearest rotation; `residual` is the largest entry of |R R^T - I|,
// infinite when the matrix is not finite or mirrors.
struct NearestRotation {
  Eigen::Quaterniond rotation;
  double residual;
};
NearestRotation nearest_rotation(const Eigen::Matrix3d& matrix);

}  // namespace stereovox
