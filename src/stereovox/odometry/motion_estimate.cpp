#include "stereovox/odometry/motion_estimate.h"

#include <Eigen/Cholesky>
#include <Eigen/SVD>
#include <cassert>
#include <cmath>
#include <limits>

namespace stereovox {
namespace {

constexpr double kBeforeCamera_m = 1e-3;
constexpr int kMinInliers = 3;
constexpr int kResidualsPerPoint = 3, kUnknowns = 6;
constexpr int kMaxRejectionRounds = 4;
// Steps below a micrometre and a microradian change nothing.
constexpr double kConverged = 1e-6;
// Reciprocal condition below which the normal equations do not fix the motion.
constexpr double kMinCondition = 1e-14;

Eigen::Vector3d weighted_mean(std::span<const Eigen::Vector3d> points,
                              std::span<const double> weights) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double total = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    sum += weights[i] * points[i];
    total += weights[i];
  }
  return sum / total;
}

struct Linearized {
  Eigen::Vector3d residual_px;
  Eigen::Matrix<double, 3, 6> jacobian;
  Eigen::Matrix3d information;  // inverse covariance of the residual
};

// Covariance of the residual: pixel noise, plus what the error of the point's own disparity does to
// its image. The rank-one form of Sherman and Morrison inverts it.
Eigen::Matrix3d residual_information(const Observation& o, const Eigen::Vector3d& d_residual) {
  const double pixel_variance = o.sigma_px * o.sigma_px;
  const double point_variance = o.sigma_disparity_px * o.sigma_disparity_px;
  const double denominator = pixel_variance + point_variance * d_residual.squaredNorm();
  return (Eigen::Matrix3d::Identity() -
          point_variance / denominator * d_residual * d_residual.transpose()) /
         pixel_variance;
}

// With T_reference_camera * exp(x) the point moves in the camera by -v - w x p.
Linearized linearize(const RectifiedCamera& camera, const Observation& o,
                     const SE3& T_camera_reference) {
  const Eigen::Vector3d p = T_camera_reference * o.p_reference;
  const Eigen::Matrix3d J = projection_jacobian(camera, p);
  Linearized result;
  result.residual_px = o.pixels - project_stereo(camera, p);
  result.jacobian.leftCols<3>() = -J;
  result.jacobian.rightCols<3>() = J * skew(p);
  result.information = residual_information(o, J * (T_camera_reference.rotation * o.dp_ddisparity));
  return result;
}

struct NormalEquations {
  Matrix6d H = Matrix6d::Zero();
  Vector6d g = Vector6d::Zero();
  double chi2 = 0.0;  // of the residuals, robustly weighted

  void add(const Linearized& l, double huber_sigmas) {
    const double distance2 = l.residual_px.dot(l.information * l.residual_px);
    const double distance = std::sqrt(distance2);
    const double weight = distance <= huber_sigmas ? 1.0 : huber_sigmas / distance;
    const Eigen::Matrix<double, 6, 3> JtW = weight * l.jacobian.transpose() * l.information;
    H += JtW * l.jacobian;
    g += JtW * l.residual_px;
    chi2 += weight * distance2;
  }
};

class Refinement {
 public:
  Refinement(const RectifiedCamera& camera, std::span<const Observation> observations,
             const SE3& start, const RefinementParams& params)
      : camera_(camera), observations_(observations), params_(params) {
    estimate_.T_reference_camera = start;
    estimate_.is_inlier.assign(observations.size(), true);
    estimate_.inliers = static_cast<int>(observations.size());
  }

  MotionEstimate run() {
    for (int round = 0; round < kMaxRejectionRounds; ++round) {
      iterate();
      if (!reject_outliers()) break;
    }
    finish();
    return estimate_;
  }

 private:
  NormalEquations normal_equations() const {
    const SE3 T_camera_reference = inverse(estimate_.T_reference_camera);
    NormalEquations equations;
    for (std::size_t i = 0; i < observations_.size(); ++i) {
      if (!estimate_.is_inlier[i]) continue;
      const Observation& o = observations_[i];
      if ((T_camera_reference * o.p_reference).z() < kBeforeCamera_m) continue;
      equations.add(linearize(camera_, o, T_camera_reference), params_.huber_sigmas);
    }
    return equations;
  }

  void iterate() {
    for (int i = 0; i < params_.max_iterations; ++i) {
      const NormalEquations equations = normal_equations();
      const Eigen::LDLT<Matrix6d> factors(equations.H);
      if (!(factors.rcond() > kMinCondition)) return;
      // r(x) = r + (d pixels - ...): the Jacobian is that of the prediction, so the step is +H^-1
      // g.
      const Vector6d step = factors.solve(equations.g);
      estimate_.T_reference_camera = estimate_.T_reference_camera * exp(step);
      if (step.norm() < kConverged) return;
    }
  }

  double residual_px(const Observation& o, const SE3& T_camera_reference) const {
    const Eigen::Vector3d p = T_camera_reference * o.p_reference;
    return p.z() < kBeforeCamera_m ? std::numeric_limits<double>::infinity()
                                   : (o.pixels - project_stereo(camera_, p)).norm();
  }

  // True when the set of inliers changed.
  bool reject_outliers() {
    const SE3 T_camera_reference = inverse(estimate_.T_reference_camera);
    std::vector<bool> before = estimate_.is_inlier;
    double sum = 0.0;
    estimate_.inliers = 0;
    for (std::size_t i = 0; i < observations_.size(); ++i) {
      const double error_px = residual_px(observations_[i], T_camera_reference);
      estimate_.is_inlier[i] = error_px <= params_.max_residual_px;
      if (!estimate_.is_inlier[i]) continue;
      ++estimate_.inliers;
      sum += error_px * error_px;
    }
    estimate_.rms_px = std::sqrt(sum / std::max(1, kResidualsPerPoint * estimate_.inliers));
    return before != estimate_.is_inlier && estimate_.inliers >= kMinInliers;
  }

  void finish() {
    estimate_.covariance.setConstant(std::numeric_limits<double>::infinity());
    if (estimate_.inliers < kMinInliers) return;
    const NormalEquations equations = normal_equations();
    const Eigen::LDLT<Matrix6d> factors(equations.H);
    if (!(factors.rcond() > kMinCondition)) return;
    const double freedom = kResidualsPerPoint * estimate_.inliers - kUnknowns;
    const double scatter = std::max(1.0, equations.chi2 / freedom);
    estimate_.covariance = scatter * factors.solve(Matrix6d::Identity());
  }

  const RectifiedCamera& camera_;
  std::span<const Observation> observations_;
  const RefinementParams& params_;
  MotionEstimate estimate_;
};

}  // namespace

SE3 closed_form_motion(std::span<const Eigen::Vector3d> from, std::span<const Eigen::Vector3d> to,
                       std::span<const double> weights) {
  assert(from.size() == to.size() && from.size() == weights.size());
  const Eigen::Vector3d mean_from = weighted_mean(from, weights),
                        mean_to = weighted_mean(to, weights);
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < from.size(); ++i)
    H += weights[i] * (from[i] - mean_from) * (to[i] - mean_to).transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(H, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs = Eigen::Vector3d::Ones();
  signs.z() = (svd.matrixV() * svd.matrixU().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  const Eigen::Matrix3d R = svd.matrixV() * signs.asDiagonal() * svd.matrixU().transpose();
  return {Eigen::Quaterniond(R).normalized(), mean_to - R * mean_from};
}

Eigen::Vector3d project_stereo(const RectifiedCamera& camera, const Eigen::Vector3d& p_camera) {
  const Eigen::Vector2d left = project(camera.pinhole, p_camera);
  return {left.x(), left.y(), left.x() - camera.disparity_px(p_camera.z())};
}

Eigen::Matrix3d projection_jacobian(const RectifiedCamera& camera, const Eigen::Vector3d& p) {
  const double iz = 1.0 / p.z(), fx = camera.pinhole.fx_px, fy = camera.pinhole.fy_px;
  Eigen::Matrix3d J;
  J << fx * iz, 0.0, -fx * p.x() * iz * iz,  //
      0.0, fy * iz, -fy * p.y() * iz * iz,   //
      fx * iz, 0.0, -fx * (p.x() - camera.baseline_m) * iz * iz;
  return J;
}

MotionEstimate refine_motion(const RectifiedCamera& camera,
                             std::span<const Observation> observations, const SE3& start,
                             const RefinementParams& params) {
  return Refinement(camera, observations, start, params).run();
}

}  // namespace stereovox
