// Ways for a round robot through a navigation map, each as short as the wish for clearance allows.
//
//   const auto way_m = plan_path(map, {0, 0}, {4, 2}, {.robot_radius_m = 0.22});
//   if (!way_m) ...  // no way
//
// For many ways from one place: cost_grid once, shortest_paths once a place, then path_to.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "stereovox/core/parameters.h"
#include "stereovox/navmap/cell_mask.h"

namespace stereovox {

struct PlannerParams {
  double robot_radius_m = 0.22;     // Pioneer 3
  double wanted_clearance_m = 0.5;  // from cell centre to obstacle centre
  double clearance_weight = 3.0;  // a step beside an obstacle costs up to 1 + this times its length
  bool unknown_is_free = false;

  void describe(ParameterList& list);
};

// Unknown cells are free when the parameters say so.
CellMask free_for_robot(const OccupancyGrid2D& map, const PlannerParams& params);

// Where the robot's centre can be and go. A move leads to one of the eight neighbours; a diagonal
// one needs both cells that it passes between.
struct CostGrid {
  GridGeometry geometry;
  std::vector<std::uint16_t> costs;  // per length travelled in the cell; kPlainCost = no surcharge
  std::vector<std::uint8_t> moves;   // bit i: kMoves[i] is possible; 0 in blocked cells
};
inline constexpr std::uint16_t kPlainCost = 256;

struct Move {
  int dx, dy;
};
// North (larger y), west, east, south, then the diagonals.
inline constexpr int kStraightMoves = 4;
inline constexpr Move kMoves[] = {{0, 1},  {-1, 0}, {1, 0},   {0, -1},
                                  {-1, 1}, {1, 1},  {-1, -1}, {1, -1}};

// A cell costs 1 + clearance_weight * max(0, 1 - clearance / wanted_clearance) times kPlainCost,
// rounded; its clearance is the distance to the nearest cell that is occupied in `map`.
CostGrid cost_grid(const OccupancyGrid2D& map, const PlannerParams& params);

// The cells of `mask` and nothing else, all at kPlainCost; diagonal moves need only their two ends.
CostGrid cost_grid_of_lines(const CellMask& mask);

// A step costs the mean cost of its two cells times its length. Of equally cheap predecessors the
// one with the smaller position is kept, so the result is one and the same on every machine.
struct ShortestPaths {
  std::vector<int> predecessors;  // kNoCell where there is no way; of the source, the source
  std::vector<int> order;         // the cells reached, each after its predecessor
};
ShortestPaths shortest_paths(const CostGrid& grid, int source);

// Fewest straight moves instead: breadth first, neighbours in the order of kMoves, first come
// stays.
ShortestPaths breadth_first_paths(const CostGrid& grid, int source);

// Positions from the source to `goal`; empty when there is no way.
std::vector<int> path_to(const ShortestPaths& paths, int goal);

// Centres of the cells from that of `start_m` to that of `goal_m`; nullopt when either cannot hold
// the robot or no way joins them. Throws UsageError as inflate does.
std::optional<std::vector<Eigen::Vector2d>> plan_path(const OccupancyGrid2D& map,
                                                      const Eigen::Vector2d& start_m,
                                                      const Eigen::Vector2d& goal_m,
                                                      const PlannerParams& params);

}  // namespace stereovox
