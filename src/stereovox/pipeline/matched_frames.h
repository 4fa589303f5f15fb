// The front half of the line, running ahead of the back half: frames are decoded, rectified and
// matched on threads of their own while earlier frames are mapped.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "stereovox/core/frame.h"
#include "stereovox/dataset/stereo_sequence.h"
#include "stereovox/pipeline/pipeline_config.h"
#include "stereovox/pipeline/stage_times.h"
#include "stereovox/stereo/rectifier.h"

namespace stereovox {

struct MatchedFrame {
  int index = 0;  // position in the recording
  RectifiedPair pair;
  DisparityImage disparity;
  Duration rectify, match;
};

// Checks the rectification of the first frames before it hands out any: throws Error when they must
// not be used (rectification_check.h). A dark frame has no disparities. With one thread everything
// runs in the caller's.
class MatchedFrames {
 public:
  MatchedFrames(StereoSequence& sequence, const Rectifier& rectifier, const PipelineConfig& config);
  ~MatchedFrames();
  MatchedFrames(const MatchedFrames&) = delete;
  MatchedFrames& operator=(const MatchedFrames&) = delete;

  // The next frame in order; nothing at the end. Passes on what the front half threw.
  std::optional<MatchedFrame> next();

  // What the check of the first frames found worth saying; "" when nothing.
  const std::string& warning() const { return warning_; }

 private:
  class Worker;
  std::optional<MatchedFrame> make_next();

  StereoSequence& sequence_;
  const Rectifier& rectifier_;
  const MatcherParams matcher_;
  const int threads_;
  std::vector<MatchedFrame> checked_;  // the first frames, rectified but not matched, last first
  std::string warning_;
  std::unique_ptr<Worker> worker_;  // none with one thread
};

}  // namespace stereovox
