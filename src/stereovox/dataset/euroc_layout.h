// The ASL layout of EuRoC: [mav0/]cam0/{sensor.yaml,data.csv,data/<stamp_ns>.png}, cam1 alike, raw
// images; truth of the body in state_groundtruth_estimate0/data.csv. Without a data.csv the file
// names are the stamps.
#pragma once

#include "stereovox/dataset/listing.h"

namespace stereovox {

bool is_euroc_layout(const std::filesystem::path& folder);
StereoRig euroc_rig(const std::filesystem::path& folder);
SequenceListing list_euroc_layout(const std::filesystem::path& folder,
                                  const SequenceParams& params);

}  // namespace stereovox
