#pragma once

#include <sstream>
#include <string>

#include "stereovox/occupancy/voxel_map_file.h"

namespace stereovox {

// What a map is in a file.
inline std::string bytes_of(const VoxelMap& map) {
  std::ostringstream out;
  write_voxel_map(out, map);
  return out.str();
}

}  // namespace stereovox
