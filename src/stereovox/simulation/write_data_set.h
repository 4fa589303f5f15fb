// A simulated drive as a folder that any reader of the field understands, with its exact truth.
//
// A rectified rig gives the plain form (left/ right/ calib.yaml times.txt poses.txt), any other the
// EuRoC/ASL form (mav0/). Beside it, for every `truth_every`-th frame
// truth/depth/NNNNNN.pfm (metres, left camera), and of a rectified rig truth/disparity/NNNNNN.pfm
// (px) and truth/occluded/NNNNNN.png (255 where the right camera does not see the point).
#pragma once

#include <filesystem>
#include <functional>

#include "stereovox/simulation/simulated_sequence.h"

namespace stereovox {

struct DataSetOptions {
  int truth_every = 1;         // 0 = no truth images
  bool keep_existing = false;  // frames whose two images exist are not rendered again
  std::function<void(int done, int frames)> progress = [](int, int) {};
  std::function<bool()> should_stop = [] { return false; };
};

// Writes frames one after the other; times and poses, which make the folder complete, last, and
// only of the frames written when it was stopped. Returns their number. Throws ResourceError.
int write_data_set(const std::filesystem::path& folder, const Simulation& simulation,
                   const DataSetOptions& options);

}  // namespace stereovox
