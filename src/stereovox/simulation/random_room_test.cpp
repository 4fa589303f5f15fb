#include "stereovox/simulation/random_room.h"

#include <gmock/gmock.h>

#include "stereovox/simulation/simulated_sequence.h"

namespace stereovox {
namespace {

TEST(RandomRoom, CanBeDrivenAndIsFurnished) {
  for (const std::uint32_t seed : {1U, 2U, 3U, 4U, 5U, 6U}) {
    const World world = random_room(seed);
    EXPECT_NO_THROW(Simulation(world, "main", {}, "room", 1)) << seed;
    EXPECT_GT(world.solids.size(), 10U) << seed;
  }
}

TEST(RandomRoom, DependsOnTheSeedOnly) {
  EXPECT_EQ(random_room_text(7, 5), random_room_text(7, 5));
  EXPECT_NE(random_room_text(7, 5), random_room_text(8, 5));
}

}  // namespace
}  // namespace stereovox
