#include "stereovox/navmap/plan_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "stereovox/navmap/drawn_map_for_test.h"

namespace stereovox {
namespace {

const PlannerParams kPoint = {.robot_radius_m = 0.0, .clearance_weight = 0.0};

// The map with the way from `start` to `goal` drawn as '*'.
Drawing drawn_way(const Drawing& drawing, const Eigen::Vector2i& start, const Eigen::Vector2i& goal,
                  const PlannerParams& params) {
  const OccupancyGrid2D map = drawn_grid(drawing);
  const auto way_m =
      plan_path(map, center_of(map.geometry, start), center_of(map.geometry, goal), params);
  Drawing result = drawing;
  if (!way_m) return {};
  for (const Eigen::Vector2d& p_m : *way_m) {
    const Eigen::Vector2i cell = index_of(map.geometry, p_m);
    result[drawing.size() - 1 - static_cast<std::size_t>(cell.y())]
          [static_cast<std::size_t>(cell.x())] = '*';
  }
  return result;
}

TEST(PlanPath, GoesAroundAWallWithoutCuttingItsCorner) {
  EXPECT_EQ(drawn_way({".....",  //
                       ".###.",  //
                       "....."},
                      {2, 0}, {2, 2}, kPoint),
            (Drawing{"***..",  //
                     "*###.",  //
                     "***.."}));
}

TEST(PlanPath, PrefersTheMiddleOfACorridorToTheShortestWay) {
  const Drawing corridor = {"#########",  //
                            ".........",  //
                            ".........",  //
                            ".........",  //
                            "#########"};
  PlannerParams careful = {.robot_radius_m = 0.0, .wanted_clearance_m = 0.3};
  EXPECT_EQ(drawn_way(corridor, {0, 1}, {8, 1}, careful), (Drawing{"#########",  //
                                                                   ".........",  //
                                                                   ".*******.",  //
                                                                   "*.......*",  //
                                                                   "#########"}));
  careful.clearance_weight = 0.0;
  EXPECT_EQ(drawn_way(corridor, {0, 1}, {8, 1}, careful)[3], "*********");
}

TEST(PlanPath, ARobotTooWideForTheGapFindsNoWay) {
  const Drawing gap = {".......",  //
                       "###.###",  //
                       "......."};
  EXPECT_FALSE(drawn_way(gap, {3, 0}, {3, 2}, kPoint).empty());
  EXPECT_TRUE(drawn_way(gap, {3, 0}, {3, 2}, {.robot_radius_m = 0.06}).empty());
}

TEST(PlanPath, UnknownCellsAreBlockedUnlessTheParametersFreeThem) {
  PlannerParams params = kPoint;
  EXPECT_TRUE(drawn_way({"..?.."}, {0, 0}, {4, 0}, params).empty());
  params.unknown_is_free = true;
  EXPECT_EQ(drawn_way({"..?.."}, {0, 0}, {4, 0}, params), Drawing{"*****"});
}

TEST(PlanPath, PlacesOffTheMapHaveNoWay) {
  EXPECT_FALSE(plan_path(drawn_grid({"..."}), {0.05, 0.05}, {7, 7}, kPoint).has_value());
}

OccupancyGrid2D random_map(unsigned seed) {
  std::mt19937 random(seed);
  Drawing drawing(19, std::string(23, '.'));
  for (std::string& line : drawing)
    for (char& c : line) c = random() % 4 == 0 ? '#' : '.';
  return drawn_grid(drawing);
}

// The costs of all cells by repeated relaxation until nothing changes.
std::vector<double> costs_by_relaxation(const CostGrid& grid, int source) {
  std::vector<double> costs(grid.costs.size(), std::numeric_limits<double>::infinity());
  costs[static_cast<std::size_t>(source)] = 0.0;
  for (bool changed = true; changed;) {
    changed = false;
    for (int i = 0; i < cell_count(grid.geometry); ++i)
      for (std::size_t m = 0; m < std::size(kMoves); ++m) {
        const auto from = static_cast<std::size_t>(i);
        if ((grid.moves[from] >> m & 1) == 0) continue;
        const auto to = from + static_cast<std::size_t>(kMoves[m].dx + kMoves[m].dy * 23);
        const double cost = costs[from] + (grid.costs[from] + grid.costs[to]) *
                                              std::hypot(kMoves[m].dx, kMoves[m].dy);
        if (cost < costs[to] - 1e-6) changed = true, costs[to] = cost;
      }
  }
  return costs;
}

TEST(ShortestPaths, CostAsMuchAsThoseFoundByRelaxingUntilNothingChanges) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const CostGrid grid = cost_grid(random_map(seed), {.robot_radius_m = 0, .clearance_weight = 9});
    int source = 0;
    while (grid.moves[static_cast<std::size_t>(source)] == 0) ++source;
    const ShortestPaths paths = shortest_paths(grid, source);
    const std::vector<double> expected = costs_by_relaxation(grid, source);
    std::vector<double> costs(expected.size(), std::numeric_limits<double>::infinity());
    costs[static_cast<std::size_t>(source)] = 0.0;
    for (const int cell : paths.order) {
      const auto to = static_cast<std::size_t>(cell);
      const int before = paths.predecessors[to];
      const auto from = static_cast<std::size_t>(before);
      const double length =
          (cell_in(grid.geometry, cell) - cell_in(grid.geometry, before)).cast<double>().norm();
      if (before != cell) costs[to] = costs[from] + (grid.costs[from] + grid.costs[to]) * length;
    }
    for (std::size_t i = 0; i < costs.size(); ++i)
      if (std::isinf(expected[i]))
        EXPECT_TRUE(std::isinf(costs[i]));
      else
        EXPECT_NEAR(costs[i], expected[i], 1e-4 * expected[i]) << i;
  }
}

TEST(ShortestPaths, OfTwoEquallyCheapWaysTheOneOverTheSmallerPositionIsTaken) {
  const OccupancyGrid2D map = drawn_grid({"...",  //
                                          ".#.",  //
                                          "..."});
  const CostGrid grid = cost_grid(map, kPoint);
  EXPECT_EQ(path_to(shortest_paths(grid, 0), 8), (std::vector{0, 1, 2, 5, 8}));
  EXPECT_EQ(path_to(shortest_paths(grid, 8), 0), (std::vector{8, 5, 2, 1, 0}));
}

TEST(ShortestPaths, BreadthFirstGoesNorthFirstAndNeverDiagonally) {
  const CostGrid grid = cost_grid(drawn_grid({"..", ".."}), kPoint);
  EXPECT_EQ(path_to(breadth_first_paths(grid, 0), 3), (std::vector{0, 2, 3}));
}

TEST(ShortestPaths, AlongLinesMayPassBetweenDiagonalNeighbours) {
  const CellMask line = cells_labelled(drawn_grid({"..#", ".#.", "#.."}), CellLabel::occupied);
  EXPECT_EQ(path_to(shortest_paths(cost_grid_of_lines(line), 0), 8), (std::vector{0, 4, 8}));
}

}  // namespace
}  // namespace stereovox
