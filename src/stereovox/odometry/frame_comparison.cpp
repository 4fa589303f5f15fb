#include "stereovox/odometry/frame_comparison.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "stereovox/core/timestamp.h"
#include "stereovox/odometry/image_difference.h"

namespace stereovox {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
// Halved images that are aligned as wholes: the coarsest bridge large steps.
constexpr std::size_t kDirectLevels = 4;
constexpr int kMinDirectHeight_px = 16;
// The first of the halved images that tell two places apart: finer ones show the pattern that
// misled the corners, and errors of the disparities, rather than what lies beneath.
constexpr std::size_t kFirstTellingLevel = 2;

double largest_sigma(const Eigen::Matrix3d& covariance) {
  if (!covariance.allFinite()) return std::numeric_limits<double>::infinity();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues().maxCoeff()));
}

std::string doubt_about(const InitialMotion& motion, const QualityParams& quality) {
  if (motion.consistent_count() < quality.min_consistent)
    return fmt::format("{} of {} matches are consistent, {} are needed", motion.consistent_count(),
                       motion.matches, quality.min_consistent);
  if (motion.consistent_count() < quality.min_consistent_share * motion.matches)
    return fmt::format("{} of {} matches are consistent, a share of {} is needed",
                       motion.consistent_count(), motion.matches, quality.min_consistent_share);
  return "";
}

std::string doubt_about_certainty(const MotionEstimate& estimate, const QualityParams& quality) {
  const double position_m = sigma_m(estimate);
  const double sigma_deg = largest_sigma(estimate.covariance.bottomRightCorner<3, 3>()) * kDegrees;
  if (position_m <= quality.max_sigma_m && sigma_deg <= quality.max_sigma_deg) return "";
  return fmt::format("motion is known to {:.3f} m and {:.2f} deg, {} and {} are needed", position_m,
                     sigma_deg, quality.max_sigma_m, quality.max_sigma_deg);
}

std::string doubt_about(const MotionEstimate& estimate, int expected,
                        const QualityParams& quality) {
  if (estimate.inliers < quality.min_inliers ||
      estimate.inliers < quality.min_inlier_share * expected)
    return fmt::format("{} of {} points fit the motion, {} and a share of {} are needed",
                       estimate.inliers, expected, quality.min_inliers, quality.min_inlier_share);
  if (estimate.rms_px > quality.max_rms_px)
    return fmt::format("reprojection error is {:.2f} px, {} are allowed", estimate.rms_px,
                       quality.max_rms_px);
  return doubt_about_certainty(estimate, quality);
}

std::string doubt_about_speed(const std::optional<LastPose>& last, std::int64_t stamp_ns,
                              int segment, const SE3& T_segment_camera,
                              const QualityParams& quality) {
  if (!last || last->segment != segment) return "";
  const double gap_s = seconds_from_ns(stamp_ns - last->stamp_ns);
  if (gap_s <= 0.0) return "";
  const SE3 motion = inverse(last->T_segment_camera) * T_segment_camera;
  const double speed = motion.translation.norm() / gap_s;
  const double turn = rotation_angle_rad(motion) * kDegrees / gap_s;
  if (speed <= quality.max_speed_m_per_s && turn <= quality.max_turn_deg_per_s) return "";
  return fmt::format("moved at {:.1f} m/s and {:.0f} deg/s, {} and {} are believed", speed, turn,
                     quality.max_speed_m_per_s, quality.max_turn_deg_per_s);
}

std::string doubt_about(const DirectAlignment& alignment, const DirectParams& params) {
  if (alignment.overlap < params.min_overlap || alignment.correlation < params.min_correlation)
    return fmt::format(
        "{:.0f} % of the keyframe is in view and correlates by {:.2f}, {:.0f} % and {} are needed",
        100.0 * alignment.overlap, alignment.correlation, 100.0 * params.min_overlap,
        params.min_correlation);
  if (alignment.residual_ratio > params.max_residual_ratio)
    return fmt::format(
        "the keyframe looks {:.1f} times as different as its own two images, {} is allowed",
        alignment.residual_ratio, params.max_residual_ratio);
  return "";
}

}  // namespace

double sigma_m(const MotionEstimate& estimate) {
  return largest_sigma(estimate.covariance.topLeftCorner<3, 3>());
}

FrameComparer::FrameComparer(const RectifiedCamera& camera, const OdometryParams& params)
    : cameras_{camera}, params_(params) {
  for (int i = 0; i < params.keyframes.coarser_levels; ++i)
    cameras_.push_back(halved(cameras_.back()));
  direct_cameras_.push_back(halved(camera));
  while (direct_cameras_.size() < kDirectLevels)
    direct_cameras_.push_back(halved(direct_cameras_.back()));
}

Comparison FrameComparer::compare(LeveledFrame& frame, const std::vector<Keyframe*>& local,
                                  const Expectation& expected) const {
  Comparison best = compare_at(frame, 0, local, expected);
  if (best.is_trusted() && best.estimate.inliers >= params_.quality.plenty_inliers) return best;
  for (std::size_t level = 1; level < local.back()->levels.size(); ++level) {
    Comparison comparison = compare_at(frame, level, local, expected);
    if (!comparison.is_trusted()) continue;
    if (!best.is_trusted() || sigma_m(comparison.estimate) < sigma_m(best.estimate))
      best = std::move(comparison);
  }
  return best;
}

Comparison FrameComparer::compare_at(LeveledFrame& frame, std::size_t level,
                                     std::vector<Keyframe*> local,
                                     const Expectation& expected) const {
  Comparison comparison{.level = level, .local = std::move(local)};
  const Keyframe& reference = comparison.reference();
  const FeatureSet& features = frame.at(level).features;
  const LevelView view{level, cameras_[level], frame.at(level).images.pair};
  comparison.initial = initial_motion(view, reference, features, expected);
  comparison.doubt = doubt_about(comparison.initial, params_.quality);
  if (!comparison.is_trusted()) return comparison;

  // First the matched corners bring the camera near, then all points give its place.
  SE3 place = reference.T_segment_camera * comparison.initial.T_reference_current;
  const std::vector<Observation> matched = sight_matches(
      view, reference, comparison.initial.consistent, features, place, params_.alignment);
  place = refine_motion(view.camera, matched, place, params_.refinement).T_reference_camera;
  const std::vector<const Keyframe*> keyframes(comparison.local.begin(), comparison.local.end());
  comparison.points = sight_points(view, keyframes, place, params_.alignment);
  std::vector<Observation> observations;
  for (const PointSighting& s : comparison.points.sightings) observations.push_back(s.observation);
  comparison.estimate = refine_motion(view.camera, observations, place, params_.refinement);
  comparison.doubt = doubt_about(comparison.estimate, comparison.points.expected, params_.quality);
  if (comparison.is_trusted())
    comparison.doubt = doubt_about_speed(expected.last, frame.stamp_ns, reference.segment,
                                         comparison.estimate.T_reference_camera, params_.quality);
  return comparison;
}

InitialMotion FrameComparer::initial_motion(const LevelView& view, const Keyframe& reference,
                                            const FeatureSet& features,
                                            const Expectation& expected) const {
  const FeatureSet& points = reference.levels[view.level].points;
  std::optional<SE3> T_reference_predicted;
  if (expected.T_segment_predicted)
    T_reference_predicted = inverse(reference.T_segment_camera) * *expected.T_segment_predicted;
  if (expected.only_near)
    return find_motion_near(view.camera, points, features, T_reference_predicted.value(),
                            params_.matching, params_.refinement);
  return find_initial_motion(view.camera, points, features, T_reference_predicted, params_.matching,
                             params_.refinement);
}

double FrameComparer::difference_ratio(LeveledFrame& frame, LeveledFrame& reference,
                                       const SE3& T_segment_reference, const SE3& T_segment_a,
                                       const SE3& T_segment_b) const {
  std::vector<ViewPair> views;
  for (std::size_t level = kFirstTellingLevel; level <= kDirectLevels; ++level) {
    if (frame.at(level).images.pair.left.height() < kMinDirectHeight_px) break;
    views.push_back(
        {direct_cameras_[level - 1], reference.at(level).images, frame.at(level).images});
  }
  const SE3 T_reference_segment = inverse(T_segment_reference);
  return stereovox::difference_ratio(views, T_reference_segment * T_segment_a,
                                     T_reference_segment * T_segment_b);
}

std::vector<SurfaceLevel> FrameComparer::surfaces_of(LeveledFrame& frame) {
  std::vector<SurfaceLevel> surfaces;
  for (std::size_t level = 1; level <= kDirectLevels; ++level) {
    const PairLevel& images = frame.at(level).images;
    if (images.pair.left.height() < kMinDirectHeight_px) break;
    surfaces.push_back({detail_of(images.pair), images.disparity.disparity_px});
  }
  return surfaces;
}

DirectAlignment FrameComparer::align(LeveledFrame& frame, const Keyframe& reference,
                                     std::span<const SE3> starts_T_segment_camera) const {
  std::vector<DetailPair> current;
  for (std::size_t i = 0; i < reference.surfaces.size(); ++i)
    current.push_back(detail_of(frame.at(i + 1).images.pair));
  std::vector<DirectPair> coarse_to_fine;
  for (std::size_t i = current.size(); i-- > 0;)
    coarse_to_fine.push_back({direct_cameras_[i], reference.surfaces[i], current[i]});
  std::vector<SE3> starts;
  for (const SE3& T_segment_start : starts_T_segment_camera)
    starts.push_back(inverse(reference.T_segment_camera) * T_segment_start);
  return align_directly(coarse_to_fine, starts);
}

Comparison FrameComparer::compare_directly(LeveledFrame& frame, Keyframe& reference,
                                           std::span<const SE3> starts_T_segment_camera,
                                           const std::optional<LastPose>& last) const {
  Comparison comparison{.level = 0, .local = {&reference}, .is_direct = true};
  if (reference.surfaces.empty()) {
    comparison.doubt = "the keyframe has forgotten its surfaces";
    return comparison;
  }
  const DirectAlignment alignment = align(frame, reference, starts_T_segment_camera);
  comparison.estimate.T_reference_camera =
      reference.T_segment_camera * alignment.T_reference_camera;
  comparison.estimate.covariance = alignment.covariance;
  comparison.doubt = doubt_about(alignment, params_.direct);
  if (comparison.is_trusted())
    comparison.doubt = doubt_about_certainty(comparison.estimate, params_.quality);
  if (comparison.is_trusted())
    comparison.doubt = doubt_about_speed(last, frame.stamp_ns, reference.segment,
                                         comparison.estimate.T_reference_camera, params_.quality);
  return comparison;
}

}  // namespace stereovox
