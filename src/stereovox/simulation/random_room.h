// Furnished rooms by the dozen, for training; none of them is a world that maps are judged on.
#pragma once

#include <cstdint>
#include <string>

#include "stereovox/simulation/world.h"

namespace stereovox {

// A room of 4 to 9 m with walls, floor and things by chance, and a drive `main` that keeps clear of
// them. The same seed gives the same room on every machine.
World random_room(std::uint32_t seed);

// Its description, as read_world reads it; `things` is how many there are.
std::string random_room_text(std::uint32_t seed, int things);

}  // namespace stereovox
