// A shot of the room as it looks when its images are halved again and again.
#pragma once

#include <vector>

#include "stereovox/odometry/image_levels.h"
#include "stereovox/odometry/room_for_test.h"

namespace stereovox {

struct HalvedLevel {
  RectifiedCamera camera;
  PairLevel images;
};

// Halved once, twice and three times.
inline std::vector<HalvedLevel> halved_levels_of(const Shot& shot) {
  constexpr int kHalvings = 3;
  std::vector<HalvedLevel> levels;
  HalvedLevel level{kCamera, {shot.pair, shot.disparity}};
  for (int i = 0; i < kHalvings; ++i) {
    level = {halved(level.camera), halved(level.images)};
    levels.push_back(level);
  }
  return levels;
}

}  // namespace stereovox
