// Where a frame was taken, from what keyframes show of it.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "stereovox/odometry/image_levels.h"
#include "stereovox/odometry/initial_motion.h"
#include "stereovox/odometry/keyframe.h"
#include "stereovox/odometry/odometry_params.h"

namespace stereovox {

// A pair with its corners, at every level that was asked for.
class LeveledFrame {
 public:
  struct Level {
    PairLevel images;
    FeatureSet features;
  };

  LeveledFrame(const RectifiedPair& pair, const DisparityImage& disparity,
               const FeatureParams& params)
      : stamp_ns(pair.stamp_ns), params_(params) {
    add({pair, disparity});
  }
  const Level& at(std::size_t level) {
    while (levels_.size() <= level) add(halved(levels_.back().images));
    return levels_[level];
  }

  const std::int64_t stamp_ns;

 private:
  void add(PairLevel images) {
    FeatureSet features = extract_features(images.pair, images.disparity, params_);
    levels_.push_back({std::move(images), std::move(features)});
  }

  const FeatureParams& params_;
  std::deque<Level> levels_;
};

struct LastPose {
  std::int64_t stamp_ns;
  int segment;
  SE3 T_segment_camera;
};

// What is known of the place of a frame before it is compared.
struct Expectation {
  std::optional<SE3> T_segment_predicted = {};  // where steady motion takes the camera
  std::optional<LastPose> last = {};            // the frame must be within reach of it
  bool only_near = false;                       // corners are matched near the prediction only
};

// What comparing a frame with keyframes gave; trusted when `doubt` is empty.
struct Comparison {
  std::size_t level;             // of the images compared
  std::vector<Keyframe*> local;  // of one segment; the last is the reference
  InitialMotion initial = {};
  MotionEstimate estimate = {};  // in the frame of the segment
  SightingSet points = {};
  bool is_direct = false;  // all pixels gave the place, without matches and points
  std::string doubt = "";

  Keyframe& reference() const { return *local.back(); }
  const FeatureSet& reference_points() const { return reference().levels[level].points; }
  bool is_trusted() const { return doubt.empty(); }
};

// Standard deviation of the position, in the direction where it is known least.
double sigma_m(const MotionEstimate& estimate);

class FrameComparer {
 public:
  FrameComparer(const RectifiedCamera& camera, const OdometryParams& params);

  std::size_t level_count() const { return cameras_.size(); }
  const RectifiedCamera& camera(std::size_t level = 0) const { return cameras_[level]; }

  // At the finest level when it has plenty of points, else at the level that knows the place best.
  // When none does, the finest tells why.
  Comparison compare(LeveledFrame& frame, const std::vector<Keyframe*>& local,
                     const Expectation& expected) const;
  Comparison compare_at(LeveledFrame& frame, std::size_t level, std::vector<Keyframe*> local,
                        const Expectation& expected) const;
  // From the brightness of all pixels instead of corners, for a camera near one of the starts.
  Comparison compare_directly(LeveledFrame& frame, Keyframe& reference,
                              std::span<const SE3> starts_T_segment_camera,
                              const std::optional<LastPose>& last) const;
  // Below 1 where all pixels speak for `a` rather than for `b` (image_difference.h). Both, as the
  // place of the reference, are in the frame of one segment.
  double difference_ratio(LeveledFrame& frame, LeveledFrame& reference,
                          const SE3& T_segment_reference, const SE3& T_segment_a,
                          const SE3& T_segment_b) const;
  // What compare_directly needs to know of a keyframe.
  static std::vector<SurfaceLevel> surfaces_of(LeveledFrame& frame);

 private:
  InitialMotion initial_motion(const LevelView& view, const Keyframe& reference,
                               const FeatureSet& features, const Expectation& expected) const;
  DirectAlignment align(LeveledFrame& frame, const Keyframe& reference,
                        std::span<const SE3> starts_T_segment_camera) const;

  std::vector<RectifiedCamera> cameras_;         // of each level, the full one first
  std::vector<RectifiedCamera> direct_cameras_;  // halved once, twice, ...
  const OdometryParams params_;
};

}  // namespace stereovox
