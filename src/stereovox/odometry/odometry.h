// Motion of the camera from stereo alone, after Hirschmueller, Innocent, Garibaldi (2002):
//
//   Odometry odometry(camera, params);
//   for (each pair) {
//     const OdometryResult motion = odometry.track(pair, match(pair, ...));
//     if (motion.status == OdometryStatus::tracked) use(motion.segment, motion.T_segment_camera);
//   }
//
// Each frame is compared with keyframes, so a camera at rest does not drift. A frame whose place is
// in doubt is `lost`, with the reason; tracking resumes when an earlier keyframe is recognised, or
// in a new segment, with a frame of its own, when the camera has been taken elsewhere. Results
// depend on the sequence of frames only, not on threads.
#pragma once

#include <deque>
#include <optional>
#include <string>

#include "stereovox/odometry/image_levels.h"
#include "stereovox/odometry/initial_motion.h"
#include "stereovox/odometry/keyframe.h"

namespace stereovox {

enum class OdometryStatus { tracked, lost };

struct QualityParams {
  int min_consistent = 10;
  double min_consistent_share = 0.1;
  int min_recognised = 20;
  int min_inliers = 12;
  int plenty_inliers = 40;
  double min_inlier_share = 0.2;
  double max_rms_px = 1.0;
  double max_sigma_m = 0.1;
  double max_sigma_deg = 1.0;
  double max_speed_m_per_s = 60.0;
  double max_turn_deg_per_s = 400.0;

  void describe(ParameterList& list) {
    list("min_consistent", min_consistent, {3, 1000}, "matches that agree on one rigid motion");
    list("min_consistent_share", min_consistent_share, {0.0, 1.0}, "their share of all matches");
    list("min_recognised", min_recognised, {3, 1000},
         "the same when finding back to an earlier keyframe");
    list("min_inliers", min_inliers, {3, 1000}, "points seen where the refined motion puts them");
    list("plenty_inliers", plenty_inliers, {3, 1000},
         "with fewer, halved images may know the place better and are asked as well");
    list("min_inlier_share", min_inlier_share, {0.0, 1.0},
         "their share of the points that should be visible");
    list("max_rms_px", max_rms_px, {0.01, 100.0}, "largest rms reprojection error");
    list("max_sigma_m", max_sigma_m, {1e-4, 100.0}, "largest standard deviation of the position");
    list("max_sigma_deg", max_sigma_deg, {1e-3, 180.0},
         "largest standard deviation of the direction");
    list("max_speed_m_per_s", max_speed_m_per_s, {0.01, 1000.0}, "faster motion is not believed");
    list("max_turn_deg_per_s", max_turn_deg_per_s, {1.0, 1e5}, "faster turning is not believed");
  }
};

struct KeyframeParams {
  double min_consistent_share = 0.25;
  double max_shift = 0.2;
  double max_turn_deg = 15.0;
  int local_count = 2;
  int stored_count = 24;
  int attempts_per_frame = 3;
  int coarser_levels = 2;

  void describe(ParameterList& list) {
    list("min_consistent_share", min_consistent_share, {0.0, 1.0},
         "a new keyframe is made when fewer of the last one's points match");
    list("max_shift", max_shift, {0.001, 10.0},
         "... when the camera has moved by more than this share of their median distance");
    list("max_turn_deg", max_turn_deg, {1.0, 180.0}, "... or has turned by more");
    list("local_count", local_count, {1, 50}, "latest keyframes that together give the place");
    list("stored_count", stored_count, {1, 1000}, "keyframes remembered to find back to");
    list("attempts_per_frame", attempts_per_frame, {0, 1000},
         "earlier keyframes that a lost frame is compared with");
    list("coarser_levels", coarser_levels, {0, 6},
         "how often images are halved where the finer ones do not give the place");
  }
};

struct OdometryParams {
  FeatureParams features;
  MatchingParams matching;
  AlignmentParams alignment;
  RefinementParams refinement;
  QualityParams quality;
  KeyframeParams keyframes;

  void describe(ParameterList& list) {
    list.section("features", features);
    list.section("matching", matching);
    list.section("alignment", alignment);
    list.section("refinement", refinement);
    list.section("quality", quality);
    list.section("keyframes", keyframes);
  }
};

struct OdometryResult {
  OdometryStatus status = OdometryStatus::lost;
  int segment = 0;  // poses of one segment share one frame; counts up from 0
  // Identity at the first frame of a segment; the last trusted pose when lost.
  SE3 T_segment_camera = {};
  // Of the twist x, in the camera's frame, in
  // T_keyframe_camera(true) = T_keyframe_camera * exp(x), the keyframe taken as exact.
  Matrix6d covariance = Matrix6d::Zero();
  int matches = 0;     // corners that look like one of the keyframe's
  int consistent = 0;  // those that agree on one rigid motion
  int expected = 0;    // points of the local keyframes that should be visible
  int inliers = 0;     // those seen where the refined motion puts them
  int level = 0;       // how often the images were halved that gave the place
  double rms_px = 0;   // their reprojection error
  bool is_keyframe = false;
  std::string reason = {};  // why lost, with the numbers; empty when tracked
};

class Odometry {
 public:
  Odometry(const RectifiedCamera& camera, const OdometryParams& params);

  // Frames in the order in which they were taken; pair.stamp_ns is the time. Throws Error when the
  // sizes of images and camera differ.
  OdometryResult track(const RectifiedPair& pair, const DisparityImage& disparity);

 private:
  struct Frame;
  struct Attempt;
  struct LastPose {
    std::int64_t stamp_ns;
    int segment;
    SE3 T_segment_camera;
  };

  void check_sizes(const RectifiedPair& pair, const DisparityImage& disparity) const;
  OdometryResult start(Frame& frame);
  OdometryResult accept(Frame& frame, const Attempt& attempt);
  OdometryResult search(Frame& frame, const Attempt& failed);
  OdometryResult lost(const Attempt& attempt) const;

  std::optional<SE3> predicted_pose(std::int64_t stamp_ns) const;
  Attempt compare(Frame& frame, const std::vector<Keyframe*>& local,
                  const std::optional<SE3>& T_segment_predicted) const;
  Attempt compare_at(Frame& frame, std::size_t level, std::vector<Keyframe*> local,
                     const std::optional<SE3>& T_segment_predicted) const;
  std::optional<Attempt> recognise(Frame& frame, bool earlier_segments_only, int attempts);
  std::optional<Attempt> begin_segment(Frame& frame);
  Keyframe make_keyframe(Frame& frame) const;
  int corner_count(Frame& frame) const;
  std::vector<Keyframe*> local_keyframes(std::size_t reference);
  std::string doubt_about_speed(std::int64_t stamp_ns, int segment,
                                const SE3& T_segment_camera) const;
  bool needs_keyframe(const Attempt& attempt) const;
  void store(Keyframe keyframe);
  void remember_pose(std::int64_t stamp_ns, const SE3& T_segment_camera);

  std::vector<RectifiedCamera> cameras_;  // of each level, the full one first
  OdometryParams params_;
  std::deque<Keyframe> keyframes_;  // of all segments, in the order in which they were made
  std::size_t reference_ = 0;       // the keyframe that frames are compared with first
  std::optional<LastPose> last_, before_last_;
  std::optional<Keyframe> candidate_;  // a lost frame, perhaps the start of a new segment
  int segments_ = 1;                   // begun so far
  std::size_t next_recognised_ = 0;    // which keyframe to look for next
};

}  // namespace stereovox
