// The door test: can the robot still pass where the plan has a doorway?
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "stereovox/navmap/occupancy_grid_2d.h"

namespace stereovox {

struct Doorway {
  std::string name;
  Eigen::Vector2d a_m = {0, 0}, b_m = {0, 0};  // the opening's two ends, at the jambs
};

// A YAML file: `doorways`, a list of {name: kitchen, a: [1.0, 2.5], b: [1.9, 2.5]} in metres of the
// map's frame. Throws Error "<path>: ..." when it is malformed or a doorway is narrower than 1 cm.
std::vector<Doorway> read_doorways(const std::filesystem::path& path);

// Whether the centre of a round robot can pass on free cells from one robot diameter before the
// opening to one behind it, without leaving the strip as wide as the opening. The map is inflated
// by the radius; unknown cells do not let it pass.
bool is_open(const Doorway& doorway, const OccupancyGrid2D& map, double robot_radius_m);

struct DoorScore {
  int doors = 0;                    // open in the ideal map: the others cannot be judged
  int open_doors = 0;               // of them, open in the generated map
  std::vector<std::string> closed;  // names of the rest
  std::vector<std::string> unseen;  // of these, those about which the map knows nothing
};
DoorScore score_doors(const std::vector<Doorway>& doorways, const OccupancyGrid2D& ideal,
                      const OccupancyGrid2D& generated, double robot_radius_m);

}  // namespace stereovox
