#include "stereovox/evaluation/path_score.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "stereovox/core/parallel.h"
#include "stereovox/evaluation/ratio.h"
#include "stereovox/evaluation/value_grid.h"
#include "stereovox/navmap/connected_cells.h"

namespace stereovox {
namespace {

PlannerParams planner_of(const PathScoreParams& params, bool unknown_is_free) {
  return {.robot_radius_m = params.robot_radius_m, .unknown_is_free = unknown_is_free};
}

// The free cell nearest to `p_m` within `radius_m`, by the distance to its centre, of several the
// one with the smallest position; kNoCell when there is none.
int snapped(const CellMask& free, const Eigen::Vector2d& p_m, double radius_m) {
  const GridGeometry& grid = free.geometry;
  const Eigen::Vector2i middle = index_of(grid, p_m);
  const int reach = static_cast<int>(std::ceil(radius_m / grid.cell_size_m));
  int nearest = kNoCell;
  double nearest_m = radius_m;
  for (int dy = -reach; dy <= reach; ++dy)
    for (int dx = -reach; dx <= reach; ++dx) {
      const Eigen::Vector2i cell = middle + Eigen::Vector2i(dx, dy);
      const double distance_m = (center_of(grid, cell) - p_m).norm();
      const bool is_nearer = nearest == kNoCell ? distance_m <= nearest_m : distance_m < nearest_m;
      if (!free.contains(cell) || !is_nearer) continue;
      nearest = position_in(grid, cell);
      nearest_m = distance_m;
    }
  return nearest;
}

struct World {
  CostGrid grid;
  CellMask blocked;            // where a path is no path
  std::vector<int> waypoints;  // kNoCell: the robot cannot stand there
};

World world_of(const OccupancyGrid2D& map, bool unknown_is_free, std::span<const int> waypoints,
               const PathScoreParams& params) {
  const PlannerParams planner = planner_of(params, unknown_is_free);
  const CellMask free = free_for_robot(map, planner);
  World world{cost_grid(map, planner), free, {}};
  for (std::uint8_t& cell : world.blocked.cells) cell ^= 1;
  for (const int waypoint : waypoints) {
    const Eigen::Vector2d p_m = center_of(map.geometry, cell_in(map.geometry, waypoint));
    world.waypoints.push_back(free.has(waypoint) ? waypoint : snapped(free, p_m, params.snap_m));
  }
  return world;
}

// In the ideal map a path is refused by obstacles only: what the plan does not tell is no obstacle.
World ideal_world_of(const OccupancyGrid2D& map, std::span<const int> waypoints,
                     const PathScoreParams& params) {
  World world = world_of(map, false, waypoints, params);
  world.blocked = free_for_robot(map, planner_of(params, true));
  for (std::uint8_t& cell : world.blocked.cells) cell ^= 1;
  return world;
}

ShortestPaths paths_from(const World& world, int source, PathRule rule) {
  return rule == PathRule::clearance ? shortest_paths(world.grid, source)
                                     : breadth_first_paths(world.grid, source);
}

// Of the paths from one waypoint to all cells.
struct Routes {
  ShortestPaths paths;           // empty when the waypoint cannot be stood on
  std::vector<double> length_m;  // of the path to each cell

  bool reach(int cell) const {
    return cell != kNoCell && !paths.order.empty() &&
           paths.predecessors[static_cast<std::size_t>(cell)] != kNoCell;
  }
};

Routes routes_from(const World& world, std::size_t waypoint, PathRule rule) {
  const int source = world.waypoints[waypoint];
  if (source == kNoCell) return {};
  const GridGeometry& grid = world.grid.geometry;
  Routes routes{paths_from(world, source, rule), std::vector<double>(world.grid.costs.size())};
  for (const int cell : routes.paths.order) {
    const int before = routes.paths.predecessors[static_cast<std::size_t>(cell)];
    const Eigen::Vector2i step = cell_in(grid, cell) - cell_in(grid, before);
    routes.length_m[static_cast<std::size_t>(cell)] =
        routes.length_m[static_cast<std::size_t>(before)] +
        step.cast<double>().norm() * grid.cell_size_m;
  }
  return routes;
}

// Whether the path to each cell touches the mask.
std::vector<std::uint8_t> touches(const ShortestPaths& paths, const CellMask& mask) {
  std::vector<std::uint8_t> touched(mask.cells.size());
  for (const int cell : paths.order) {
    const auto i = static_cast<std::size_t>(cell);
    touched[i] = mask.cells[i] | touched[static_cast<std::size_t>(paths.predecessors[i])];
  }
  return touched;
}

struct Comparison {
  const World &ideal, &generated;
  PathRule rule;

  // Pairs of waypoint `from` with later ones.
  PathCounts count_from(std::size_t from, const Routes& there) const {
    const Routes here = routes_from(generated, from, rule);
    const std::vector<std::uint8_t> collides = touches(here.paths, ideal.blocked);
    const std::vector<std::uint8_t> is_lost = touches(there.paths, generated.blocked);
    PathCounts counts;
    for (std::size_t to = from + 1; to < ideal.waypoints.size(); ++to) {
      const int goal_there = ideal.waypoints[to], goal_here = generated.waypoints[to];
      const auto i = static_cast<std::size_t>(goal_there), j = static_cast<std::size_t>(goal_here);
      const bool exists = there.reach(goal_there), found = here.reach(goal_here);
      counts.ideal_pairs += exists;
      counts.generated_pairs += found;
      counts.false_positives += found && collides[j] != 0;
      counts.false_negatives += exists && !found;
      counts.strict_false_negatives += exists && is_lost[i] != 0;
      if (!exists || !found) continue;
      ++counts.common_pairs;
      counts.ideal_length_m += there.length_m[i];
      counts.generated_length_m += here.length_m[j];
    }
    return counts;
  }
};

void add(const PathCounts& part, PathCounts& sum) {
  sum.ideal_pairs += part.ideal_pairs;
  sum.generated_pairs += part.generated_pairs;
  sum.false_positives += part.false_positives;
  sum.false_negatives += part.false_negatives;
  sum.strict_false_negatives += part.strict_false_negatives;
  sum.common_pairs += part.common_pairs;
  sum.ideal_length_m += part.ideal_length_m;
  sum.generated_length_m += part.generated_length_m;
}

std::optional<double> percent(std::int64_t part, std::int64_t whole) {
  return ratio(100.0 * static_cast<double>(part), static_cast<double>(whole));
}

}  // namespace

std::optional<double> PathCounts::false_positive_percent() const {
  return percent(false_positives, generated_pairs);
}
std::optional<double> PathCounts::false_negative_percent() const {
  return percent(false_negatives, ideal_pairs);
}
std::optional<double> PathCounts::strict_false_negative_percent() const {
  return percent(strict_false_negatives, ideal_pairs);
}
std::optional<double> PathCounts::length_ratio() const {
  return ratio(generated_length_m, ideal_length_m);
}

std::vector<int> waypoints_of(const OccupancyGrid2D& ideal, const PathScoreParams& params) {
  const GridGeometry& grid = ideal.geometry;
  const CellMask free = largest_piece(free_for_robot(ideal, planner_of(params, false)));
  const auto points_along = [&](int cells) {
    const double length_m = cells * grid.cell_size_m - params.waypoint_offset_m;
    return static_cast<int>(std::floor(length_m / params.waypoint_pitch_m)) + 1;
  };
  std::vector<int> waypoints;
  for (int j = 0; j < points_along(grid.height); ++j)
    for (int i = 0; i < points_along(grid.width); ++i) {
      const Eigen::Array2d from_origin_m =
          Eigen::Array2d(i, j) * params.waypoint_pitch_m + params.waypoint_offset_m;
      const int cell = snapped(free, grid.origin_m + from_origin_m.matrix(), params.snap_m);
      if (cell != kNoCell) waypoints.push_back(cell);
    }
  std::ranges::sort(waypoints);
  const auto repeated = std::ranges::unique(waypoints);
  waypoints.erase(repeated.begin(), repeated.end());
  return waypoints;
}

PathScore compare_paths(const OccupancyGrid2D& ideal, const OccupancyGrid2D& generated,
                        std::span<const int> waypoints, const PathScoreParams& params) {
  const World truth = ideal_world_of(ideal, waypoints, params);
  const World blocked = world_of(generated, false, waypoints, params);
  const World open = world_of(generated, true, waypoints, params);
  std::vector<std::array<PathCounts, 2>> counts(waypoints.size());
  parallel_for(0, static_cast<int>(waypoints.size()), params.threads, [&](int i) {
    const auto from = static_cast<std::size_t>(i);
    const Routes there = routes_from(truth, from, params.rule);
    counts[from] = {Comparison{truth, blocked, params.rule}.count_from(from, there),
                    Comparison{truth, open, params.rule}.count_from(from, there)};
  });
  PathScore score{static_cast<int>(waypoints.size()), {}, {}};
  for (const auto& [with_blocked, with_free] : counts) {
    add(with_blocked, score.unknown_blocked);
    add(with_free, score.unknown_free);
  }
  return score;
}

PathScore score_paths(const IdealMap& ideal, const OccupancyGrid2D& generated,
                      const PathScoreParams& params) {
  const OccupancyGrid2D plan = planning_map(ideal);
  const GridGeometry region = union_of(plan.geometry, generated.geometry);
  std::vector<int> waypoints = waypoints_of(plan, params);
  const Eigen::Vector2i offset = lattice_offset(region, plan.geometry);
  for (int& waypoint : waypoints)
    waypoint = position_in(region, cell_in(plan.geometry, waypoint) + offset);
  return compare_paths(extended_to(plan, region), extended_to(generated, region), waypoints,
                       params);
}

}  // namespace stereovox
