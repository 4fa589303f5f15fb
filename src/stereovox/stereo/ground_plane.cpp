#include "stereovox/stereo/ground_plane.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "stereovox/core/angles.h"

namespace stereovox {
namespace {

constexpr int kTrials = 400;
constexpr int kRefinements = 3;
constexpr int kMaxSamples = 4000;
constexpr int kMinSamples = 100;
constexpr unsigned kSeed = 1;

// Rows are (x, y, 1) with x, y relative to the principal point, in focal lengths: then the plane
// d = n . (x, y, 1) is the plane n . p = fx B in camera coordinates.
struct Samples {
  Eigen::MatrixX3d rays;
  Eigen::VectorXd disparities_px;
};

Samples lower_half(const DisparityImage& disparity, const PinholeCamera& camera) {
  std::vector<Eigen::Vector4d> found;
  const int pixels = disparity.width() * disparity.height() / 2;
  const int step = std::max(1, static_cast<int>(std::sqrt(pixels / kMaxSamples)));
  for (int v = disparity.height() / 2; v < disparity.height(); v += step)
    for (int u = 0; u < disparity.width(); u += step)
      if (const float d = disparity.disparity_px(v, u); d > 0.0F)
        found.emplace_back((u - camera.cx_px) / camera.fx_px, (v - camera.cy_px) / camera.fy_px,
                           1.0, d);
  Samples samples;
  const auto count = static_cast<Eigen::Index>(found.size());
  samples.rays.resize(count, 3);
  samples.disparities_px.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    samples.rays.row(i) = found[static_cast<std::size_t>(i)].head<3>().transpose();
    samples.disparities_px(i) = found[static_cast<std::size_t>(i)].w();
  }
  return samples;
}

GroundPlane plane_from(const Eigen::Vector3d& n, const RectifiedCamera& camera) {
  return {n.normalized(), camera.pinhole.fx_px * camera.baseline_m / n.norm(), 0.0};
}

bool is_plausible(const GroundPlane& plane, const GroundPlaneParams& params) {
  const Eigen::Vector3d& down = plane.down_camera;
  const double tilt_rad = std::asin(std::clamp(down.z(), -1.0, 1.0));
  const double roll_rad = std::atan2(down.x(), down.y());
  return std::abs(tilt_rad) <= params.max_tilt_deg * kDegree_rad &&
         std::abs(roll_rad) <= params.max_roll_deg * kDegree_rad &&
         plane.height_m >= params.min_height_m && plane.height_m <= params.max_height_m;
}

using Members = Eigen::Array<bool, Eigen::Dynamic, 1>;

Members members_of(const Samples& samples, const Eigen::Vector3d& n, double tolerance_px) {
  return (samples.rays * n - samples.disparities_px).array().abs() <= tolerance_px;
}

Eigen::Vector3d least_squares(const Samples& samples, const Members& members) {
  const Eigen::VectorXd weights = members.cast<double>();
  const Eigen::Matrix3d A = samples.rays.transpose() * weights.asDiagonal() * samples.rays;
  const Eigen::Vector3d b =
      samples.rays.transpose() * (weights.array() * samples.disparities_px.array()).matrix();
  return A.ldlt().solve(b);
}

Eigen::Vector3d best_of_random_planes(const Samples& samples, const RectifiedCamera& camera,
                                      const GroundPlaneParams& params) {
  std::mt19937 random(kSeed);
  std::uniform_int_distribution<Eigen::Index> any(0, samples.rays.rows() - 1);
  Eigen::Vector3d best = Eigen::Vector3d::Zero();
  Eigen::Index best_count = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    Eigen::Matrix3d rays;
    Eigen::Vector3d disparities_px;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Index chosen = any(random);
      rays.row(i) = samples.rays.row(chosen);
      disparities_px(i) = samples.disparities_px(chosen);
    }
    const Eigen::Vector3d n = rays.fullPivLu().solve(disparities_px);
    if (!n.allFinite() || !is_plausible(plane_from(n, camera), params)) continue;
    const Eigen::Index count = members_of(samples, n, params.tolerance_px).count();
    if (count > best_count) {
      best_count = count;
      best = n;
    }
  }
  return best;
}

}  // namespace

std::optional<GroundPlane> estimate_ground_plane(const DisparityImage& disparity,
                                                 const RectifiedCamera& camera,
                                                 const GroundPlaneParams& params) {
  const Samples samples = lower_half(disparity, camera.pinhole);
  if (samples.rays.rows() < kMinSamples) return std::nullopt;
  Eigen::Vector3d n = best_of_random_planes(samples, camera, params);
  if (n.isZero()) return std::nullopt;
  for (int i = 0; i < kRefinements; ++i)
    n = least_squares(samples, members_of(samples, n, params.tolerance_px));
  GroundPlane plane = plane_from(n, camera);
  plane.share = static_cast<double>(members_of(samples, n, params.tolerance_px).count()) /
                static_cast<double>(samples.rays.rows());
  if (!is_plausible(plane, params) || 100.0 * plane.share < params.min_share_percent)
    return std::nullopt;
  return plane;
}

}  // namespace stereovox
