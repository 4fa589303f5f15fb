// The map_server format of ROS 1 and Nav2: an image beside a YAML file. Here is what writer and
// reader share; write_map_server_test.cpp has the readers of the several versions.
#pragma once

#include <span>
#include <string>

namespace stereovox {

enum class MapServerMode {
  trinary,  // free, occupied, unknown
  scale,    // free cells graded by their state; unknown is transparent
  raw,      // the numbers 0, 100, 255 as they are
};
std::span<const std::string> names_of(MapServerMode);

// Darkness = (255 - grey) / 255. Occupied is darker than the first, free lighter than the second.
// 205, the customary grey of unknown, has 0.19608: just not free. Readers that print 0.25 by
// default take it for free (slam_toolbox#587), so the thresholds are always written.
inline constexpr double kOccupiedThreshold = 0.65, kFreeThreshold = 0.196;
inline constexpr int kWhite = 255, kFreeGrey = 254, kUnknownGrey = 205, kOccupiedGrey = 0;

// Raw mode: percent, and what is above 100 is unknown.
inline constexpr int kRawFree = 0, kRawOccupied = 100, kRawUnknown = 255;

}  // namespace stereovox
