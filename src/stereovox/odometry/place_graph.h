// The places where a camera has been: keyframes, and the motions measured between them. When the
// camera comes back to a place, or merely sees it again from near by, one more motion is measured,
// and all poses can be moved to where they fit together best. Errors then do not grow with the
// length of the way, but with the distance from places seen twice.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "stereovox/odometry/frame_comparison.h"
#include "stereovox/odometry/pose_graph.h"

namespace stereovox {

// A frame of known place. Poses of one segment share one frame.
struct PlacedFrame {
  std::int64_t stamp_ns = 0;
  int segment = 0;
  SE3 T_segment_camera = {};
};

class PlaceGraph {
 public:
  PlaceGraph(const FrameComparer& comparer, const OdometryParams& params)
      : comparer_(comparer), params_(params) {}

  // In the order in which they were made. Older ones show their finest level only; some of them
  // nothing, when the memory would not suffice.
  std::deque<Keyframe>& keyframes() { return keyframes_; }
  const std::deque<Keyframe>& keyframes() const { return keyframes_; }
  std::size_t index_of(const Keyframe& keyframe) const;

  void add_keyframe(Keyframe keyframe);
  // The last keyframe as seen from another: `comparison` placed it.
  void link_last(const Comparison& comparison);
  // Compares the frame, which is the last keyframe, with earlier keyframes that show the same.
  void find_links(LeveledFrame& frame);

  // A frame that was tracked, near a keyframe.
  void add_frame(std::int64_t stamp_ns, std::size_t keyframe, const SE3& T_segment_camera);

  // All frames, after the keyframes were moved to where all links fit best. Segments that a link
  // connects are one, with the number and the origin of the first of them.
  std::vector<PlacedFrame> placed_frames() const;

 private:
  struct Frame {
    std::int64_t stamp_ns;
    std::size_t keyframe;
    SE3 T_keyframe_camera;
  };
  struct Placement {
    int segment;  // the first of those that are connected
    SE3 T_first_segment;
  };

  std::vector<std::size_t> candidates() const;
  bool is_believable(const PoseLink& link) const;
  void save_memory();
  bool place_across(const PoseLink& link, std::vector<std::optional<Placement>>& placements) const;
  // Of each segment.
  std::vector<std::optional<Placement>> connected_segments() const;

  const FrameComparer& comparer_;
  const OdometryParams params_;
  std::deque<Keyframe> keyframes_;
  std::vector<double> way_m_;  // travelled up to each keyframe
  std::vector<PoseLink> links_;
  std::vector<Frame> frames_;
};

}  // namespace stereovox
