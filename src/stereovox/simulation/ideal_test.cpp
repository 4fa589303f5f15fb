#include "stereovox/simulation/ideal.h"

#include <gmock/gmock.h>

#include "stereovox/core/error.h"
#include "stereovox/simulation/room_for_test.h"

namespace stereovox {
namespace {

// Rows from the largest y down, '#' occupied, '.' not.
std::vector<std::string> drawn(const OccupiedCells& cells) {
  std::vector<std::string> rows;
  const auto width = static_cast<std::size_t>(cells.geometry.width);
  for (int y = cells.geometry.height - 1; y >= 0; --y) {
    rows.emplace_back();
    for (std::size_t x = 0; x < width; ++x)
      rows.back() += cells.is_occupied[static_cast<std::size_t>(y) * width + x] ? '#' : '.';
  }
  return rows;
}

World small_room(const std::string& things) {
  return parse_world(
      "name: r\nroom: {size_m: [3, 2], wall_thickness_m: 0.5}\nlights: {}\nthings: [" + things +
          "]\ndrives: {main: {waypoints: [[1, 1]]}}",
      "r.yaml");
}

TEST(OccupiedCells, ShowWallsAndThingsOfTheBand) {
  const World world = small_room(
      "{kind: box, at: [1.25, 0.75], size_m: [0.5, 0.5, 1]},"
      "{kind: box, at: [2.25, 1.25], size_m: [0.5, 0.5, 0.1]},"                // too low
      "{kind: box, at: [0.25, 0.25], size_m: [0.5, 0.5, 0.5], bottom_m: 2}");  // too high
  EXPECT_THAT(drawn(occupied_cells(world, 0.5, {})),
              testing::ElementsAre("########",  //
                                   "#......#",  //
                                   "#......#",  //
                                   "#..#...#",  //
                                   "#......#",  //
                                   "########"));
}

TEST(OccupiedCells, AFaceThatGrazesACellDoesNotCount) {
  EXPECT_THAT(drawn(occupied_cells(
                  small_room("{kind: box, at: [1.27, 0.75], size_m: [0.5, 0.5, 1]}"), 0.5, {}))[3],
              "#..#...#");  // reaches 2 cm into the next cell
  EXPECT_THAT(drawn(occupied_cells(
                  small_room("{kind: box, at: [1.35, 0.75], size_m: [0.5, 0.5, 1]}"), 0.5, {}))[3],
              "#..##..#");  // 10 cm
}

TEST(OccupiedCells, AThinLegBetweenTwoCellsCountsForBoth) {
  EXPECT_THAT(drawn(occupied_cells(
                  small_room("{kind: box, at: [1.5, 0.75], size_m: [0.04, 0.04, 1]}"), 0.5, {}))[3],
              "#..##..#");
}

TEST(OccupiedCells, RefusesGridsThatAreTooLarge) {
  EXPECT_THROW(occupied_cells(room_for_test(), 0.0005, {}), UsageError);
}

TEST(OccupiedVoxels, HaveTheHeightOfTheThings) {
  const World world =
      small_room("{kind: table, at: [1.25, 0.75], size_m: [0.5, 0.5, 0.7], leg_m: 0.1}");
  const OccupiedVoxels voxels = occupied_voxels(world, 0.1, {.min_m = 0.0, .max_m = 1.0});
  const auto at = [&](int x, int y, int z) {
    return voxels.is_occupied[voxels.position_of({x, y, z})];
  };
  EXPECT_EQ(voxels.size.z(), 10);
  EXPECT_TRUE(at(12, 7, 6));   // the plate
  EXPECT_FALSE(at(12, 7, 3));  // the space below it
  EXPECT_TRUE(at(10, 5, 3));   // a leg
  EXPECT_FALSE(at(12, 7, 7));
  EXPECT_TRUE(at(-3, 7, 9));  // a wall
}

}  // namespace
}  // namespace stereovox
