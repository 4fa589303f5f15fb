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

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "stereovox/odometry/frame_comparison.h"
#include "stereovox/odometry/place_graph.h"

namespace stereovox {

enum class OdometryStatus { tracked, lost };

struct OdometryResult {
  OdometryStatus status = OdometryStatus::lost;
  int segment = 0;  // poses of one segment share one frame; counts up from 0
  // Identity at the first frame of a segment; the last trusted pose when lost.
  SE3 T_segment_camera = {};
  // Of the twist x, in the camera's frame, in
  // T_keyframe_camera(true) = T_keyframe_camera * exp(x), the keyframe taken as exact.
  Matrix6d covariance = Matrix6d::Zero();
  // All 0 on later frames where the brightness of all pixels gave the place (direct_alignment.h).
  int matches = 0;     // corners that look like one of the keyframe's
  int consistent = 0;  // those that agree on one rigid motion
  int expected = 0;    // points of the local keyframes that should be visible
  int inliers = 0;     // those seen where the refined motion puts them
  double rms_px = 0;   // their reprojection error
  int level = 0;       // how often the images were halved whose corners gave the place
  bool is_keyframe = false;
  std::string reason = {};  // why lost, with the numbers; empty when tracked
};

class Odometry {
 public:
  Odometry(const RectifiedCamera& camera, const OdometryParams& params);
  Odometry(const Odometry&) = delete;
  Odometry& operator=(const Odometry&) = delete;

  // Frames in the order in which they were taken; pair.stamp_ns is the time. Throws Error when the
  // sizes of images and camera differ.
  OdometryResult track(const RectifiedPair& pair, const DisparityImage& disparity);

  // The tracked frames once more, with all that is known by now: places that were seen twice fit
  // together, and segments that show the same place are one.
  std::vector<PlacedFrame> placed_frames() const { return places_.placed_frames(); }

 private:
  void check_sizes(const RectifiedPair& pair, const DisparityImage& disparity) const;
  OdometryResult place(LeveledFrame& frame);
  Comparison look_closer(LeveledFrame& frame, Comparison found,
                         const std::optional<SE3>& T_segment_predicted);
  Comparison best_around(LeveledFrame& frame, Comparison found, const SE3& T_segment_predicted);
  bool fits_better(LeveledFrame& frame, const Comparison& a, const Comparison& b) const;
  bool are_apart(const SE3& a, const SE3& b, const Comparison& seen) const;
  OdometryResult start(LeveledFrame& frame);
  OdometryResult accept(LeveledFrame& frame, const Comparison& comparison);
  OdometryResult accept_in_earlier_segment(LeveledFrame& frame, const Comparison& later,
                                           const Comparison& earlier);
  OdometryResult search(LeveledFrame& frame, const Comparison& failed);
  OdometryResult lost(const Comparison& comparison) const;

  std::optional<SE3> predicted_pose(std::int64_t stamp_ns) const;
  std::optional<Comparison> recognise(LeveledFrame& frame, bool earlier_segments_only,
                                      int attempts);
  std::optional<Comparison> find_near_last_pose(LeveledFrame& frame,
                                                const std::optional<SE3>& T_segment_predicted);
  Comparison with_keyframe(Comparison near);
  std::optional<Comparison> begin_segment(LeveledFrame& frame);
  Keyframe make_keyframe(LeveledFrame& frame) const;
  void add_keyframe(LeveledFrame& frame, const Comparison& comparison);
  int corner_count(LeveledFrame& frame) const;
  std::vector<Keyframe*> local_keyframes(std::size_t reference);
  bool needs_keyframe(const Comparison& comparison) const;
  void absorb_sightings(const Comparison& comparison);
  void remember_pose(std::int64_t stamp_ns, const SE3& T_segment_camera);

  OdometryParams params_;
  FrameComparer comparer_;
  PlaceGraph places_;          // of all segments
  std::size_t reference_ = 0;  // the keyframe that frames are compared with first
  std::optional<LastPose> last_, before_last_;
  std::unique_ptr<LeveledFrame> last_frame_;  // placed last
  bool last_is_keyframe_ = false;
  std::optional<Comparison> last_comparison_;  // of the last frame, when it is no keyframe
  std::optional<Keyframe> last_view_;          // what all pixels are compared with
  std::optional<Keyframe> candidate_;          // a lost frame, perhaps the start of a new segment
  int segments_ = 1;                           // begun so far
  std::size_t next_recognised_ = 0;            // which keyframe to look for next
};

}  // namespace stereovox
