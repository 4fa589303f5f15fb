// The shape of free space, apart from distances: a room cut off or a pillar lost changes it.
#pragma once

#include "stereovox/navmap/cell_mask.h"

namespace stereovox {

struct Topology {
  int components = 0;    // pieces that hang together over edges
  int euler_number = 0;  // components - holes; holes hang together over edges or corners
};

Topology topology_of(const CellMask& cells);

}  // namespace stereovox
