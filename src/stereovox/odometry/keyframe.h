// Frames that later frames are compared with: where they were, what they looked like, and points of
// which they knew the distance.
#pragma once

#include <optional>
#include <span>

#include "stereovox/core/se3.h"
#include "stereovox/odometry/direct_alignment.h"
#include "stereovox/odometry/feature_matching.h"
#include "stereovox/odometry/motion_estimate.h"

namespace stereovox {

// What a keyframe knows at one level of its images (image_levels.h).
struct KeyframeLevel {
  GrayImage left;
  FeatureSet points;
};

struct Keyframe {
  int segment = 0;
  SE3 T_segment_camera = {};
  std::vector<KeyframeLevel> levels = {};
  std::vector<SurfaceLevel> surfaces = {};  // halved once, twice, ...
};

// Of the points, of which there is at least one.
double median_depth_m(const RectifiedCamera& camera, const FeatureSet& points);

struct AlignmentParams {
  int max_points = 150;
  double max_shift_px = 3.0;
  double min_correlation = 0.8;
  double sigma_px = 0.15;

  void describe(ParameterList& list) {
    list("max_points", max_points, {20, 5000}, "points whose image is measured in one frame");
    list("max_shift_px", max_shift_px, {0.5, 20.0},
         "farther from where a point is expected its image is not looked for");
    list("min_correlation", min_correlation, {0.0, 1.0},
         "least normalised correlation of a point's images");
    list("sigma_px", sigma_px, {0.01, 5.0}, "standard deviation of an aligned image position");
  }
};

// The disparity of each point is measured again, by aligning its surroundings in the right image;
// where that fails the matcher's value stays.
KeyframeLevel make_keyframe_level(const RectifiedPair& pair, FeatureSet features,
                                  const AlignmentParams& params);

// The image of point `point` of keyframe `keyframe` (indices) in the current pair. Coordinates of
// the observation are those of the keyframes' segment.
struct PointSighting {
  std::size_t keyframe, point;
  Observation observation;
};

struct SightingSet {
  std::vector<PointSighting> sightings;
  int expected = 0;  // cells of the image in which a point was looked for
};

// A camera's images at one level, and which one it is.
struct LevelView {
  std::size_t level;
  const RectifiedCamera& camera;
  const RectifiedPair& pair;
};

// Looks for the points of keyframes of one segment where they should be if the camera is at
// `T_segment_camera`: at most one in each cell of the image, the earlier keyframe's before the
// later's, because a longer memory drifts less.
SightingSet sight_points(const LevelView& view, std::span<const Keyframe* const> keyframes,
                         const SE3& T_segment_camera, const AlignmentParams& params);

// Looks for points of one keyframe around the corners of the current frame that match them; the
// place of the camera shapes the patches only.
std::vector<Observation> sight_matches(const LevelView& view, const Keyframe& keyframe,
                                       std::span<const FeatureMatch> matches,
                                       const FeatureSet& current, const SE3& T_segment_camera,
                                       const AlignmentParams& params);

// Improves the disparity of a keyframe's point by one more sighting from a known place.
void absorb(const RectifiedCamera& camera, const Observation& observation,
            const SE3& T_segment_camera, Feature& point);

}  // namespace stereovox
