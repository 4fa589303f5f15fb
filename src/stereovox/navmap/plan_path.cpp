#include "stereovox/navmap/plan_path.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <span>

#include "stereovox/navmap/distance_field.h"
#include "stereovox/navmap/inflate.h"

namespace stereovox {
namespace {

using Cost = std::uint64_t;
constexpr Cost kUnreached = std::numeric_limits<Cost>::max();

// Lengths of a straight and a diagonal move: 239 / 169 is sqrt(2) to 1.3e-5, and integers make ties
// exact.
constexpr Cost kStraight = 169, kDiagonal = 239;
constexpr double kMaxWeight = 100.0;  // so that a cell's cost fits 16 bits

constexpr int kMoveCount = static_cast<int>(std::size(kMoves));

// Whether a diagonal move may pass between two cells of which one is blocked.
enum class Corners { keep_off, cut };

std::uint8_t moves_from(const CellMask& free, const Eigen::Vector2i& cell, Corners corners) {
  const auto is_free = [&](int dx, int dy) {
    return free.contains(cell + Eigen::Vector2i(dx, dy));
  };
  unsigned moves = 0;
  for (int i = 0; i < kMoveCount; ++i) {
    const auto [dx, dy] = kMoves[i];
    const bool passes =
        i < kStraightMoves || corners == Corners::cut || (is_free(dx, 0) && is_free(0, dy));
    if (passes && is_free(dx, dy)) moves |= 1U << i;
  }
  return static_cast<std::uint8_t>(moves);
}

CostGrid plain_grid(const CellMask& free, Corners corners) {
  const GridGeometry& grid = free.geometry;
  CostGrid result{grid, std::vector(free.cells.size(), kPlainCost),
                  std::vector(free.cells.size(), std::uint8_t{0})};
  for (int i = 0; i < cell_count(grid); ++i)
    if (free.has(i))
      result.moves[static_cast<std::size_t>(i)] = moves_from(free, cell_in(grid, i), corners);
  return result;
}

std::uint16_t cost_at(double clearance_m, const PlannerParams& params) {
  const double lack = std::max(0.0, 1.0 - clearance_m / params.wanted_clearance_m);
  return static_cast<std::uint16_t>(
      std::lround(kPlainCost * (1.0 + params.clearance_weight * lack)));
}

std::array<int, kMoveCount> position_steps(const GridGeometry& grid) {
  std::array<int, kMoveCount> steps;
  std::ranges::transform(kMoves, steps.begin(),
                         [&](const Move& move) { return move.dy * grid.width + move.dx; });
  return steps;
}

// Cells in buckets no wider than the cheapest step. No step joins two cells of one bucket, so the
// cost of every cell in the cheapest bucket is final, in whatever order they are taken (Dinitz
// 1978). Widths and counts are powers of two, because divisions would take most of the time.
class BucketQueue {
 public:
  struct Entry {
    Cost cost;
    int cell;
  };

  BucketQueue(Cost cheapest_step, Cost dearest_step)
      : shift_(std::bit_width(cheapest_step) - 1),
        buckets_(std::bit_ceil((dearest_step >> shift_) + 2)) {}

  void push(Cost cost, int cell) {
    buckets_[cost >> shift_ & (buckets_.size() - 1)].push_back({cost, cell});
    ++waiting_;
  }
  bool is_empty() const { return waiting_ == 0; }
  // Valid until the next call.
  std::span<const Entry> take_cheapest() {
    while (buckets_[current_].empty()) current_ = (current_ + 1) & (buckets_.size() - 1);
    taken_.clear();
    taken_.swap(buckets_[current_]);
    waiting_ -= taken_.size();
    return taken_;
  }

 private:
  int shift_;
  std::vector<std::vector<Entry>> buckets_;  // a ring; open costs span less than all of it
  std::vector<Entry> taken_;
  std::size_t current_ = 0, waiting_ = 0;
};

class Search {
 public:
  Search(const CostGrid& grid, int source)
      : grid_(grid),
        steps_(position_steps(grid.geometry)),
        costs_(grid.costs.size(), kUnreached),
        queue_(2 * kPlainCost * kStraight, 2 * *std::ranges::max_element(grid.costs) * kDiagonal),
        paths_{std::vector(grid.costs.size(), kNoCell), {}} {
    reach(source, source, 0);
  }

  ShortestPaths run() && {
    while (!queue_.is_empty())
      for (const BucketQueue::Entry& entry : queue_.take_cheapest())
        if (entry.cost == costs_[static_cast<std::size_t>(entry.cell)]) settle(entry);
    return std::move(paths_);
  }

 private:
  void settle(const BucketQueue::Entry& entry) {
    const auto from = static_cast<std::size_t>(entry.cell);
    paths_.order.push_back(entry.cell);
    for (int i = 0; i < kMoveCount; ++i) {
      if ((grid_.moves[from] >> i & 1) == 0) continue;
      const int to = entry.cell + steps_[static_cast<std::size_t>(i)];
      const Cost both = Cost{grid_.costs[from]} + grid_.costs[static_cast<std::size_t>(to)];
      reach(to, entry.cell, entry.cost + both * (i < kStraightMoves ? kStraight : kDiagonal));
    }
  }

  void reach(int cell, int predecessor, Cost cost) {
    const auto i = static_cast<std::size_t>(cell);
    if (cost > costs_[i]) return;
    if (cost == costs_[i]) {
      paths_.predecessors[i] = std::min(paths_.predecessors[i], predecessor);
      return;
    }
    costs_[i] = cost;
    paths_.predecessors[i] = predecessor;
    queue_.push(cost, cell);
  }

  const CostGrid& grid_;
  std::array<int, kMoveCount> steps_;
  std::vector<Cost> costs_;
  BucketQueue queue_;
  ShortestPaths paths_;
};

}  // namespace

void PlannerParams::describe(ParameterList& list) {
  list("robot_radius_m", robot_radius_m, {0.0, 10.0}, "obstacles grow by this");
  list("wanted_clearance_m", wanted_clearance_m, {0.001, 100.0},
       "nearer to an obstacle's centre a step costs more");
  list("clearance_weight", clearance_weight, {0.0, kMaxWeight},
       "how many times its length a step at an obstacle costs more");
  list("unknown_is_free", unknown_is_free, "the robot may go where nothing is known");
}

CellMask free_for_robot(const OccupancyGrid2D& map, const PlannerParams& params) {
  const OccupancyGrid2D inflated = inflate(map, params.robot_radius_m);
  CellMask free = cells_labelled(inflated, CellLabel::free);
  if (params.unknown_is_free)
    for (std::size_t i = 0; i < free.cells.size(); ++i)
      free.cells[i] |= inflated.labels[i] == CellLabel::unknown;
  return free;
}

CostGrid cost_grid(const OccupancyGrid2D& map, const PlannerParams& params) {
  CostGrid grid = plain_grid(free_for_robot(map, params), Corners::keep_off);
  const DistanceField2D clearance = distance_field(cells_labelled(map, CellLabel::occupied));
  for (std::size_t i = 0; i < grid.costs.size(); ++i)
    grid.costs[i] = cost_at(clearance.distance_m[i], params);
  return grid;
}

CostGrid cost_grid_of_lines(const CellMask& mask) { return plain_grid(mask, Corners::cut); }

ShortestPaths shortest_paths(const CostGrid& grid, int source) {
  return Search(grid, source).run();
}

ShortestPaths breadth_first_paths(const CostGrid& grid, int source) {
  const auto steps = position_steps(grid.geometry);
  ShortestPaths paths{std::vector(grid.costs.size(), kNoCell), {source}};
  paths.predecessors[static_cast<std::size_t>(source)] = source;
  for (std::size_t next = 0; next < paths.order.size(); ++next) {
    const int from = paths.order[next];
    for (int i = 0; i < kStraightMoves; ++i) {
      if ((grid.moves[static_cast<std::size_t>(from)] >> i & 1) == 0) continue;
      const int to = from + steps[static_cast<std::size_t>(i)];
      if (paths.predecessors[static_cast<std::size_t>(to)] != kNoCell) continue;
      paths.predecessors[static_cast<std::size_t>(to)] = from;
      paths.order.push_back(to);
    }
  }
  return paths;
}

std::vector<int> path_to(const ShortestPaths& paths, int goal) {
  const auto before = [&](int cell) { return paths.predecessors[static_cast<std::size_t>(cell)]; };
  if (before(goal) == kNoCell) return {};
  std::vector<int> path = {goal};
  while (before(path.back()) != path.back()) path.push_back(before(path.back()));
  std::ranges::reverse(path);
  return path;
}

std::optional<std::vector<Eigen::Vector2d>> plan_path(const OccupancyGrid2D& map,
                                                      const Eigen::Vector2d& start_m,
                                                      const Eigen::Vector2d& goal_m,
                                                      const PlannerParams& params) {
  const CellMask free = free_for_robot(map, params);
  const Eigen::Vector2i start = index_of(map.geometry, start_m);
  const Eigen::Vector2i goal = index_of(map.geometry, goal_m);
  if (!free.contains(start) || !free.contains(goal)) return std::nullopt;
  const ShortestPaths paths =
      shortest_paths(cost_grid(map, params), position_in(map.geometry, start));
  const std::vector<int> cells = path_to(paths, position_in(map.geometry, goal));
  if (cells.empty()) return std::nullopt;
  std::vector<Eigen::Vector2d> way_m;
  for (const int cell : cells)
    way_m.push_back(center_of(map.geometry, cell_in(map.geometry, cell)));
  return way_m;
}

}  // namespace stereovox
