// The figures of a map's shape: topology and doorways.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "stereovox/core/error.h"
#include "stereovox/evaluation/doorways.h"
#include "stereovox/evaluation/topology.h"
#include "stereovox/io/temporary_folder.h"
#include "stereovox/navmap/drawn_map_for_test.h"

namespace stereovox {
namespace {

Topology free_topology(const Drawing& drawing) {
  return topology_of(cells_labelled(drawn_grid(drawing), CellLabel::free));
}

TEST(Topology, CountsPiecesAndHoles) {
  const Topology t = free_topology({".....#.",  //
                                    ".#.#.#.",  //
                                    ".....#."});
  EXPECT_EQ(t.components, 2);
  EXPECT_EQ(t.euler_number, 2 - 2);
}

TEST(Topology, PiecesThatTouchAtACornerAreTwoAndHolesThatDoAreOne) {
  EXPECT_EQ(free_topology({".#", "#."}).euler_number, 2);
  EXPECT_EQ(free_topology({"....",  //
                           ".#..",  //
                           "..#.",  //
                           "...."})
                .euler_number,
            1 - 1);
}

// A wall of 0.1 m cells with an opening of `width` cells, its middle at (1.5, 1.05) m.
OccupancyGrid2D wall_with_opening(int width, char floor = '.') {
  Drawing drawing(21, std::string(30, '.'));
  drawing[10] = std::string(30, '#');
  for (int x = 15 - width / 2; x < 15 - width / 2 + width; ++x)
    drawing[10][static_cast<std::size_t>(x)] = floor;
  return drawn_grid(drawing, 0.1);
}
const Doorway kDoor = {"door", {1.1, 1.05}, {1.9, 1.05}};

TEST(Doorways, AreOpenWhenTheRobotFitsThrough) {
  EXPECT_TRUE(is_open(kDoor, wall_with_opening(8), 0.22));
  EXPECT_FALSE(is_open(kDoor, wall_with_opening(4), 0.22));
  EXPECT_FALSE(is_open(kDoor, wall_with_opening(0), 0.22));
  EXPECT_FALSE(is_open(kDoor, wall_with_opening(8, '?'), 0.22));
}

TEST(Doorways, AnotherWayAroundDoesNotOpenThem) {
  OccupancyGrid2D map = wall_with_opening(0);
  for (int x = 20; x < 30; ++x) map.labels[map.position_of({x, 10})] = CellLabel::free;
  EXPECT_FALSE(is_open(kDoor, map, 0.1));
}

TEST(Doorways, AnObstacleInTheWayWithinARobotsDiameterClosesThem) {
  OccupancyGrid2D map = wall_with_opening(8);
  for (int x = 5; x < 25; ++x) map.labels[map.position_of({x, 13})] = CellLabel::occupied;
  EXPECT_FALSE(is_open(kDoor, map, 0.22));
}

TEST(Doorways, MayLieInAnyDirection) {
  Drawing free(40, std::string(40, '.'));
  OccupancyGrid2D map = drawn_grid(free, 0.1);
  for (int i = 0; i < 40; ++i)
    if (i < 15 || i > 24)
      for (const int x : {i, std::min(i + 1, 39)})
        map.labels[map.position_of({x, i})] = CellLabel::occupied;
  const Doorway diagonal = {"diagonal", {1.6, 1.6}, {2.5, 2.5}};
  EXPECT_TRUE(is_open(diagonal, map, 0.22));
  for (int i = 0; i < 39; ++i)
    for (const int x : {i, i + 1}) map.labels[map.position_of({x, i})] = CellLabel::occupied;
  EXPECT_FALSE(is_open(diagonal, map, 0.22));
}

TEST(Doorways, OnlyThoseThatAreOpenInThePlanAreJudged) {
  const DoorScore s = score_doors({kDoor, {"wall", {0.1, 1.05}, {0.9, 1.05}}}, wall_with_opening(8),
                                  wall_with_opening(2), 0.22);
  EXPECT_EQ(s.doors, 1);
  EXPECT_EQ(s.open_doors, 0);
  EXPECT_EQ(s.closed, std::vector<std::string>{"door"});
  EXPECT_TRUE(s.unseen.empty());
  OccupancyGrid2D unknown = wall_with_opening(8);
  std::ranges::fill(unknown.labels, CellLabel::unknown);
  EXPECT_EQ(score_doors({kDoor}, wall_with_opening(8), unknown, 0.22).unseen,
            std::vector<std::string>{"door"});
}

std::string complaint_about(const std::string& yaml) {
  const TemporaryFolder folder;
  try {
    read_doorways(folder.write("doors.yaml", yaml));
  } catch (const Error& error) {
    return std::string(error.what()).substr(folder.path().string().size() + 1);
  }
  return "";
}

TEST(Doorways, AreReadFromYaml) {
  const TemporaryFolder folder;
  const std::vector<Doorway> doorways = read_doorways(
      folder.write("doors.yaml", "doorways:\n  - {name: kitchen, a: [1, 2.5], b: [1.9, 2.5]}\n"));
  ASSERT_EQ(doorways.size(), 1U);
  EXPECT_EQ(doorways[0].name, "kitchen");
  EXPECT_EQ(doorways[0].b_m, Eigen::Vector2d(1.9, 2.5));
}

TEST(Doorways, FilesThatAreMalformedAreRefused) {
  EXPECT_EQ(complaint_about("doors: 3"), "doors.yaml: 'doorways' is missing");
  EXPECT_EQ(complaint_about("doorways: 3"), "doors.yaml: 'doorways' is not a list");
  EXPECT_EQ(complaint_about("doorways: [3]"), "doors.yaml: is not {name, a, b}");
  EXPECT_EQ(complaint_about("doorways: [{name: d, a: [1, 1], b: [1, 1.001]}]"),
            "doors.yaml: doorway 'd' is 0.001 m wide, less than 0.01 m");
}

}  // namespace
}  // namespace stereovox
