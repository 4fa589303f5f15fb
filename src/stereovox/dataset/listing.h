// What a layout finds in a folder before any image is read.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "stereovox/core/trajectory.h"
#include "stereovox/dataset/stereo_sequence.h"

namespace stereovox {

// An image of one camera.
struct ListedImage {
  std::int64_t stamp_ns = 0;
  int index = 0;  // position in the recording
  std::filesystem::path path;
};

struct ListedPair {
  std::int64_t stamp_ns = 0;  // of the left image
  int index = 0;              // position of the left image in the recording
  std::filesystem::path left, right;
};

struct SequenceListing {
  SequenceInfo info;
  std::vector<ListedPair> pairs;  // by strictly increasing time
  Trajectory truth;               // of the left camera as calibrated
};

}  // namespace stereovox
