#include "stereovox/odometry/initial_motion.h"

#include <cmath>
#include <vector>

#include "stereovox/odometry/rigidity.h"

namespace stereovox {
namespace {

constexpr int kMinPoints = 3;
constexpr double kNearestProjected_m = 0.05;
// A corner is found to the pixel, and not at quite the same place of the surface each time.
constexpr double kCornerSigma_px = 0.7;

MeasuredPoint measured(const RectifiedCamera& camera, const Feature& feature) {
  // The disparity is the difference of two columns.
  return {position_of(camera, feature), feature.sigma_px / std::sqrt(2.0)};
}

struct MatchedPoints {
  std::vector<MeasuredPoint> reference, current;
};

MatchedPoints measure(const RectifiedCamera& camera, const FeatureSet& reference,
                      const FeatureSet& current, std::span<const FeatureMatch> matches) {
  MatchedPoints points;
  for (const FeatureMatch& match : matches) {
    points.reference.push_back(
        measured(camera, reference.features[static_cast<std::size_t>(match.reference)]));
    points.current.push_back(
        measured(camera, current.features[static_cast<std::size_t>(match.current)]));
  }
  return points;
}

// From the consistent matches; near points count more, by the inverse variance of their depths.
SE3 fit_closed_form(const MatchedPoints& points, std::span<const int> cluster) {
  std::vector<Eigen::Vector3d> from, to;
  std::vector<double> weights;
  for (const int index : cluster) {
    const MeasuredPoint& a = points.current[static_cast<std::size_t>(index)];
    const MeasuredPoint& b = points.reference[static_cast<std::size_t>(index)];
    from.push_back(a.p_camera);
    to.push_back(b.p_camera);
    weights.push_back(1.0 / (std::pow(a.pixel_error_px * a.p_camera.z() * a.p_camera.z(), 2) +
                             std::pow(b.pixel_error_px * b.p_camera.z() * b.p_camera.z(), 2)));
  }
  return closed_form_motion(from, to, weights);
}

Observation observation_of(const RectifiedCamera& camera, const Feature& reference,
                           const Feature& current) {
  const Eigen::Vector3d p_reference = position_of(camera, reference);
  return {
      .p_reference = p_reference,
      .dp_ddisparity = -p_reference / reference.disparity_px,
      .sigma_disparity_px = reference.sigma_px,
      .pixels = {current.pixel.x(), current.pixel.y(), current.pixel.x() - current.disparity_px},
      .sigma_px = kCornerSigma_px};
}

InitialMotion motion_from(const RectifiedCamera& camera, const FeatureSet& reference,
                          const FeatureSet& current, std::span<const FeatureMatch> matches,
                          const MatchingParams& params, const RefinementParams& refinement) {
  const MatchedPoints points = measure(camera, reference, current, matches);
  const std::vector<int> cluster = largest_consistent_cluster(
      consistency_of(camera, points.reference, points.current, params.max_sigmas));
  InitialMotion motion{.matches = static_cast<int>(matches.size())};
  for (const int index : cluster)
    motion.consistent.push_back(matches[static_cast<std::size_t>(index)]);
  if (motion.consistent_count() < kMinPoints) return motion;

  std::vector<Observation> observations;
  for (const FeatureMatch& match : motion.consistent)
    observations.push_back(
        observation_of(camera, reference.features[static_cast<std::size_t>(match.reference)],
                       current.features[static_cast<std::size_t>(match.current)]));
  motion.T_reference_current =
      refine_motion(camera, observations, fit_closed_form(points, cluster), refinement)
          .T_reference_camera;
  return motion;
}

// Where the reference features are after the motion; those behind the camera are nowhere.
std::vector<Eigen::Vector2d> expected_pixels(const RectifiedCamera& camera,
                                             const FeatureSet& reference,
                                             const std::optional<SE3>& T_reference_predicted) {
  std::vector<Eigen::Vector2d> pixels;
  for (const Feature& feature : reference.features) {
    if (!T_reference_predicted) {
      pixels.push_back(feature.pixel);
      continue;
    }
    const Eigen::Vector3d p = inverse(*T_reference_predicted) * position_of(camera, feature);
    pixels.push_back(p.z() > kNearestProjected_m
                         ? project(camera.pinhole, p)
                         : Eigen::Vector2d::Constant(-camera.pinhole.width));
  }
  return pixels;
}

InitialMotion motion_within(double window, const RectifiedCamera& camera,
                            const FeatureSet& reference, const FeatureSet& current,
                            const std::optional<SE3>& T_reference_predicted,
                            const MatchingParams& params, const RefinementParams& refinement) {
  const auto expected = expected_pixels(camera, reference, T_reference_predicted);
  const auto matches = match_features(reference, expected, current, window * camera.pinhole.width,
                                      params.min_correlation);
  return motion_from(camera, reference, current, matches, params, refinement);
}

// On a repeated pattern a wrong motion finds many consistent matches too, but not most of them.
bool is_convincing(const InitialMotion& motion, const MatchingParams& params) {
  return motion.consistent_count() >= params.enough_consistent &&
         motion.consistent_count() >= params.enough_consistent_share * motion.matches;
}

}  // namespace

InitialMotion find_motion_near(const RectifiedCamera& camera, const FeatureSet& reference,
                               const FeatureSet& current, const SE3& T_reference_predicted,
                               const MatchingParams& params, const RefinementParams& refinement) {
  return motion_within(params.predicted_window, camera, reference, current, T_reference_predicted,
                       params, refinement);
}

InitialMotion find_initial_motion(const RectifiedCamera& camera, const FeatureSet& reference,
                                  const FeatureSet& current,
                                  const std::optional<SE3>& T_reference_predicted,
                                  const MatchingParams& params,
                                  const RefinementParams& refinement) {
  InitialMotion best;
  const auto attempt = [&](const std::optional<SE3>& T_predicted, double window) {
    const InitialMotion motion =
        motion_within(window, camera, reference, current, T_predicted, params, refinement);
    if (motion.consistent.size() > best.consistent.size() || best.matches == 0) best = motion;
  };
  if (T_reference_predicted) attempt(T_reference_predicted, params.predicted_window);
  if (is_convincing(best, params)) return best;
  attempt(std::nullopt, params.narrow_window);
  attempt(std::nullopt, params.wide_window);
  return best;
}

}  // namespace stereovox
