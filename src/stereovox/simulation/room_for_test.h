// A small empty room for tests: 6 x 4 m, a box of 1 x 1 x 1 m with its near face at x = 4.
#pragma once

#include <string>

#include "stereovox/simulation/world_file.h"

namespace stereovox {

inline std::string room_text(const std::string& more = "") {
  return R"(
name: room
room: {size_m: [6, 4], height_m: 2.5, floor: carpet, wall: brick}
lights: {ambient: 0.4, spacing_m: [2, 2]}
things:
  - {kind: box, at: [4.5, 2], size_m: [1, 1, 1], material: poster}
drives:
  main: {speed_m_s: 0.5, rate_hz: 2, waypoints: [[1, 2], [2.5, 2]]}
)" + more;
}

inline World room_for_test(const std::string& more = "") {
  return parse_world(room_text(more), "room.yaml");
}

}  // namespace stereovox
