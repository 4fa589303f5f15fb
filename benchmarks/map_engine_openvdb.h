// OpenVDB as a peer, used as mapping packages use it.
#pragma once

#include "map_engine_measure.h"

namespace stereovox::bench {

// Whether this build has OpenVDB; run_openvdb must not be called without.
bool has_openvdb_peer();

// A float grid of log-odds with OctoMap's numbers. Each point's ray is walked into a grid of flags,
// which then changes each voxel once a frame; where a ray ends it is hit.
Result run_openvdb(const Case& c, const std::vector<Frame>& frames, const Truth& truth);

}  // namespace stereovox::bench
