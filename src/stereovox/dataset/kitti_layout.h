// The KITTI odometry layout: calib.txt, times.txt and image_0/ image_1/ (grey) or image_2/ image_3/
// (colour), rectified. Truth is poses.txt in the folder or ../../poses/<folder name>.txt.
#pragma once

#include "stereovox/dataset/listing.h"

namespace stereovox {

bool is_kitti_layout(const std::filesystem::path& folder);
StereoRig kitti_rig(const std::filesystem::path& folder);
SequenceListing list_kitti_layout(const std::filesystem::path& folder,
                                  const SequenceParams& params);

}  // namespace stereovox
