#include "stereovox/odometry/keyframe.h"

#include <algorithm>
#include <cmath>

#include "stereovox/odometry/patch_alignment.h"

namespace stereovox {
namespace {

constexpr double kMinDepth_m = 0.05;
// A patch that is seen more than three times larger or smaller has another texture.
constexpr double kMaxScale = 3.0;
// Errors that do not average out: shape of the patch, calibration.
constexpr double kMinSigma_px = 0.04;

Observation observation_of(const RectifiedCamera& camera, const Keyframe& keyframe,
                           const Feature& point) {
  const Eigen::Vector3d p_keyframe = position_of(camera, point);
  return {.p_reference = keyframe.T_segment_camera * p_keyframe,
          .dp_ddisparity = keyframe.T_segment_camera.rotation *
                           Eigen::Vector3d(-p_keyframe / point.disparity_px),
          .sigma_disparity_px = point.sigma_px,
          .pixels = Eigen::Vector3d::Zero(),
          .sigma_px = 0.0};
}

// How offsets in the current image look in the keyframe's, for a surface that faces the keyframe.
Eigen::Matrix2d keyframe_from_current(const RectifiedCamera& camera, const Feature& point,
                                      const SE3& T_camera_keyframe) {
  const auto seen_at = [&](double du, double dv) {
    return project(camera.pinhole,
                   T_camera_keyframe * triangulate(camera, point.pixel.x() + du,
                                                   point.pixel.y() + dv, point.disparity_px));
  };
  Eigen::Matrix2d current_from_keyframe;
  current_from_keyframe.col(0) = 0.5 * (seen_at(1, 0) - seen_at(-1, 0));
  current_from_keyframe.col(1) = 0.5 * (seen_at(0, 1) - seen_at(0, -1));
  return current_from_keyframe.inverse();
}

bool is_moderate(const Eigen::Matrix2d& map) {
  const double area = map.determinant();
  return area > 1.0 / (kMaxScale * kMaxScale) && area < kMaxScale * kMaxScale;
}

// Where the patch lies in both images of the pair: u_left, v, u_right.
std::optional<Eigen::Vector3d> align_in_both(const PatchTemplate& patch, const RectifiedPair& pair,
                                             const Eigen::Vector3d& expected_px,
                                             const AlignmentParams& params) {
  const auto left = align_patch(patch, pair.left.pixels, expected_px.head<2>(),
                                AlignmentFreedom::both_axes, params.max_shift_px);
  if (!left || left->score < params.min_correlation) return std::nullopt;
  const double disparity_px = expected_px.x() - expected_px.z();
  const auto right =
      align_patch(patch, pair.right.pixels, {left->pixel.x() - disparity_px, left->pixel.y()},
                  AlignmentFreedom::along_row, params.max_shift_px);
  if (!right || right->score < params.min_correlation) return std::nullopt;
  return Eigen::Vector3d(left->pixel.x(), left->pixel.y(), right->pixel.x());
}

enum class CellState : unsigned char { untouched, tried, seen };

// Cells of the current image, each of which takes one point.
class CellGrid {
 public:
  CellGrid(const PinholeCamera& camera, int max_points)
      : size_px_(std::max(
            1.0, std::sqrt(static_cast<double>(camera.width) * camera.height / max_points))),
        columns_(static_cast<int>(camera.width / size_px_) + 1),
        rows_(static_cast<int>(camera.height / size_px_) + 1),
        cells_(static_cast<std::size_t>(columns_ * rows_), CellState::untouched) {}

  // The cell a pixel of the image lies in.
  CellState& at(const Eigen::Vector2d& pixel) {
    return cells_[static_cast<std::size_t>(static_cast<int>(pixel.y() / size_px_) * columns_ +
                                           static_cast<int>(pixel.x() / size_px_))];
  }

 private:
  double size_px_;
  int columns_, rows_;
  std::vector<CellState> cells_;
};

bool is_visible(const RectifiedPair& pair, const Eigen::Vector2d& pixel) {
  if (!(pixel.x() >= 0.0 && pixel.y() >= 0.0 && pixel.x() <= pair.left.width() - 1 &&
        pixel.y() <= pair.left.height() - 1))
    return false;
  return pair.valid_left.empty() ||
         pair.valid_left(static_cast<int>(pixel.y()), static_cast<int>(pixel.x())) != 0;
}

std::optional<Observation> sight(const LevelView& view, const Keyframe& keyframe,
                                 const Feature& point, const SE3& T_camera_keyframe,
                                 const Eigen::Vector3d& expected_px,
                                 const AlignmentParams& params) {
  const Eigen::Matrix2d map = keyframe_from_current(view.camera, point, T_camera_keyframe);
  if (!is_moderate(map)) return std::nullopt;
  const auto patch = cut_patch(keyframe.levels[view.level].left.pixels, point.pixel, map);
  if (!patch) return std::nullopt;
  const auto pixels = align_in_both(*patch, view.pair, expected_px, params);
  if (!pixels) return std::nullopt;
  Observation observation = observation_of(view.camera, keyframe, point);
  observation.pixels = *pixels;
  observation.sigma_px = params.sigma_px;
  return observation;
}

}  // namespace

double median_depth_m(const RectifiedCamera& camera, const FeatureSet& points) {
  std::vector<double> depths;
  for (const Feature& point : points.features) depths.push_back(camera.depth_m(point.disparity_px));
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  return *middle;
}

KeyframeLevel make_keyframe_level(const RectifiedPair& pair, FeatureSet features,
                                  const AlignmentParams& params) {
  for (Feature& point : features.features) {
    const auto patch = cut_patch(pair.left.pixels, point.pixel, Eigen::Matrix2d::Identity());
    if (!patch) continue;
    const Eigen::Vector2d expected_px(point.pixel.x() - point.disparity_px, point.pixel.y());
    const auto right = align_patch(*patch, pair.right.pixels, expected_px,
                                   AlignmentFreedom::along_row, params.max_shift_px);
    if (!right || right->score < params.min_correlation) continue;
    const double disparity_px = point.pixel.x() - right->pixel.x();
    if (disparity_px <= 0.0) continue;
    point.disparity_px = disparity_px;
    point.sigma_px = std::sqrt(2.0) * params.sigma_px;
  }
  return {{pair.left.pixels.clone()}, std::move(features)};
}

SightingSet sight_points(const LevelView& view, std::span<const Keyframe* const> keyframes,
                         const SE3& T_segment_camera, const AlignmentParams& params) {
  CellGrid cells(view.camera.pinhole, params.max_points);
  SightingSet set;
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    const Keyframe& keyframe = *keyframes[k];
    const SE3 T_camera_keyframe = inverse(T_segment_camera) * keyframe.T_segment_camera;
    const std::vector<Feature>& points = keyframe.levels[view.level].points.features;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector3d p_camera = T_camera_keyframe * position_of(view.camera, points[i]);
      if (p_camera.z() < kMinDepth_m) continue;
      const Eigen::Vector3d expected_px = project_stereo(view.camera, p_camera);
      if (!is_visible(view.pair, expected_px.head<2>())) continue;
      CellState& cell = cells.at(expected_px.head<2>());
      if (cell == CellState::seen) continue;
      set.expected += cell == CellState::untouched ? 1 : 0;
      const auto seen = sight(view, keyframe, points[i], T_camera_keyframe, expected_px, params);
      cell = seen ? CellState::seen : CellState::tried;
      if (seen) set.sightings.push_back({k, i, *seen});
    }
  }
  return set;
}

std::vector<Observation> sight_matches(const LevelView& view, const Keyframe& keyframe,
                                       std::span<const FeatureMatch> matches,
                                       const FeatureSet& current, const SE3& T_segment_camera,
                                       const AlignmentParams& params) {
  const SE3 T_camera_keyframe = inverse(T_segment_camera) * keyframe.T_segment_camera;
  const std::vector<Feature>& points = keyframe.levels[view.level].points.features;
  std::vector<Observation> observations;
  for (const FeatureMatch& match : matches) {
    const Feature& point = points[static_cast<std::size_t>(match.reference)];
    const Feature& corner = current.features[static_cast<std::size_t>(match.current)];
    if ((T_camera_keyframe * position_of(view.camera, point)).z() < kMinDepth_m) continue;
    const Eigen::Vector3d expected_px(corner.pixel.x(), corner.pixel.y(),
                                      corner.pixel.x() - corner.disparity_px);
    if (const auto seen = sight(view, keyframe, point, T_camera_keyframe, expected_px, params))
      observations.push_back(*seen);
  }
  return observations;
}

void absorb(const RectifiedCamera& camera, const Observation& observation,
            const SE3& T_segment_camera, Feature& point) {
  const SE3 T_camera_segment = inverse(T_segment_camera);
  const auto pixels_at = [&](double change_px) {
    return project_stereo(camera, T_camera_segment * (observation.p_reference +
                                                      change_px * observation.dp_ddisparity));
  };
  constexpr double kStep_px = 1e-3;
  const Eigen::Vector3d slope = (pixels_at(kStep_px) - pixels_at(-kStep_px)) / (2.0 * kStep_px);
  const Eigen::Vector3d residual = observation.pixels - pixels_at(0.0);
  const double prior = 1.0 / (point.sigma_px * point.sigma_px);
  const double pixel_weight = 1.0 / (observation.sigma_px * observation.sigma_px);
  const double information = prior + pixel_weight * slope.squaredNorm();
  const double disparity_px = point.disparity_px + pixel_weight * slope.dot(residual) / information;
  if (!(disparity_px > 0.0)) return;
  point.disparity_px = disparity_px;
  point.sigma_px = std::max(kMinSigma_px, 1.0 / std::sqrt(information));
}

}  // namespace stereovox
