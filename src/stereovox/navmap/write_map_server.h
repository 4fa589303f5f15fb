// Navigation maps for map_server of ROS 1 and Nav2, made so that every version reads the same.
#pragma once

#include <filesystem>

#include "stereovox/navmap/map_server.h"
#include "stereovox/navmap/occupancy_grid_2d.h"

namespace stereovox {

// Writes the image, then `yaml_path`, both atomically; so a YAML file always has its whole image.
//   trinary, raw: <stem>.pgm, 8-bit grey; raw keeps the labels exactly.
//   scale:        <stem>_scale.png with alpha, for unknown has no grey in this mode. The value of
//                 a free cell is its state in percent; occupied is 100.
// Throws ResourceError when a file cannot be written.
void write_map_server(const std::filesystem::path& yaml_path, const OccupancyGrid2D& grid,
                      MapServerMode mode = MapServerMode::trinary);

}  // namespace stereovox
