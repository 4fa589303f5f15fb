// Navigation maps from map_server files of any origin.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "stereovox/navmap/map_server.h"
#include "stereovox/navmap/occupancy_grid_2d.h"

namespace stereovox {

struct LoadedMap {
  OccupancyGrid2D grid;
  std::filesystem::path image_path;
  MapServerMode mode = MapServerMode::trinary;
  std::string convention;            // one line for people: how pixels were read
  std::vector<std::string> remarks;  // one line each: what other readers may see differently
};

// Accepts: a missing mode (trinary), `negate` as 0, 1, true or false, quoted numbers, an absolute
// image path from another machine (then the image beside the YAML file), PGM, PNG, BMP; grey,
// colour (averaged, as map_server does), transparent pixels (unknown). Cells: darker than
// occupied_thresh are occupied, lighter than free_thresh free. Between, trinary is unknown; scale
// and raw have a state there, and are occupied when it is above one half. Throws Error "<path>:
// ..." for what is missing, malformed, turned (yaw) or larger than kMaxCells.
LoadedMap read_map_server(const std::filesystem::path& yaml_path);

}  // namespace stereovox
