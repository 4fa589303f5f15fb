// A recording of a stereo camera, read frame by frame:
//
//   const std::unique_ptr<StereoSequence> sequence = open_sequence("office_a");
//   while (const std::optional<StereoFrame> frame = sequence->next()) use(*frame, sequence->rig());
//
// Time stamps of the delivered frames strictly increase. Pairs that cannot be used (unreadable, of
// another size) are skipped and recorded; too many of them are an Error.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "stereovox/core/camera.h"
#include "stereovox/core/frame.h"
#include "stereovox/core/parameters.h"
#include "stereovox/core/trajectory.h"

namespace stereovox {

struct SkippedPair {
  std::string name;    // of the left image
  std::string reason;  // the error text, which names the file
};

struct SequenceInfo {
  std::string layout;  // "plain", "KITTI odometry", "EuRoC/ASL"
  std::filesystem::path path;
  int pairs = 0;                      // to be delivered, if all can be read
  int left_only = 0, right_only = 0;  // images without a partner; left out
  int duplicates = 0;                 // pairs with the time stamp of another; left out
  int gaps = 0;                       // places where the numbering of the left images skips
  std::vector<std::string> remarks;   // for the user, one line each; may grow while reading
};

// The one virtual interface of the code base.
class StereoSequence {
 public:
  StereoSequence() = default;
  virtual ~StereoSequence();
  StereoSequence(const StereoSequence&) = delete;
  StereoSequence& operator=(const StereoSequence&) = delete;

  virtual const StereoRig& rig() const = 0;  // validated
  virtual const SequenceInfo& info() const = 0;
  virtual const Trajectory& truth() const = 0;    // of the left camera as calibrated; may be empty
  virtual std::optional<StereoFrame> next() = 0;  // nothing at the end; throws Error
  virtual std::span<const SkippedPair> skipped() const = 0;  // so far; valid until next()
};

struct SequenceParams {
  double start_s = 0.0, duration_s = 0.0;
  int max_frames = 0, frame_skip = 0;
  double max_skipped_percent = 5.0;
  double max_stamp_difference_s = 0.005;
  double assumed_rate_hz = 10.0;

  void describe(ParameterList& list);
};

}  // namespace stereovox
