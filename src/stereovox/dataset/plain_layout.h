// The plain layout: left/ right/ calib.yaml times.txt [poses.txt], rectified images.
#pragma once

#include "stereovox/dataset/listing.h"

namespace stereovox {

bool is_plain_layout(const std::filesystem::path& folder);
StereoRig plain_rig(const std::filesystem::path& folder);
SequenceListing list_plain_layout(const std::filesystem::path& folder,
                                  const SequenceParams& params);

}  // namespace stereovox
