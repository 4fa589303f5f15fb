// What one moment of the stereo camera looks like, before and after rectification. The two types
// differ on purpose: matching unrectified images does not compile.
#pragma once

#include <cstdint>
#include <string>

#include "stereovox/core/image.h"

namespace stereovox {

// As recorded: both images have the size of the rig's cameras.
struct StereoFrame {
  std::int64_t stamp_ns = 0;
  int index = 0;     // position in the recording, counted before anything was skipped
  std::string name;  // for messages: the left image's file name
  GrayImage left, right;
};

// Corresponding points lie in the same row, the right one not to the right of the left one.
struct RectifiedPair {
  std::int64_t stamp_ns = 0;
  GrayImage left, right;
  cv::Mat1b valid_left, valid_right;  // 255 where the recorded image had a pixel; empty = all
};

}  // namespace stereovox
