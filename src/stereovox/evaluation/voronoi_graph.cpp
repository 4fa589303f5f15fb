#include "stereovox/evaluation/voronoi_graph.h"

#include <algorithm>
#include <array>

#include "stereovox/navmap/distance_field.h"
#include "stereovox/navmap/plan_path.h"

namespace stereovox {
namespace {

// Nearer lines run between the cells of one obstacle (the tool's advice).
constexpr double kLeastClearance_cells = 1.5;

// Counter-clockwise from the east, so that every other one shares an edge with the cell.
constexpr int kAround[8][2] = {{1, 0},  {1, 1},   {0, 1},  {-1, 1},
                               {-1, 0}, {-1, -1}, {0, -1}, {1, -1}};

std::array<bool, 8> neighbours_of(const CellMask& mask, int position) {
  const Eigen::Vector2i cell = cell_in(mask.geometry, position);
  std::array<bool, 8> set;
  for (std::size_t i = 0; i < set.size(); ++i)
    set[i] = mask.contains(cell + Eigen::Vector2i(kAround[i][0], kAround[i][1]));
  return set;
}

// Yokoi's connectivity number: how many pieces of the eight-connected set meet at the cell. At 1
// the cell can go without changing the set's topology.
int pieces_meeting(const std::array<bool, 8>& around) {
  int pieces = 0;
  for (std::size_t i = 0; i < around.size(); i += 2) {
    const bool gap = !around[i], next = around[i + 1], after = around[(i + 2) % around.size()];
    pieces += gap && (next || after);
  }
  return pieces;
}

class Ridges {
 public:
  Ridges(const OccupancyGrid2D& map, double robot_radius_m)
      : free_(free_for_robot(map, {.robot_radius_m = robot_radius_m})),
        field_(distance_field(cells_labelled(map, CellLabel::occupied))),
        clearance_m_(std::max(robot_radius_m, kLeastClearance_cells * map.geometry.cell_size_m)) {}

  bool is_on_ridge(int position) const {
    if (!may_pass(position)) return false;
    const Eigen::Vector2i cell = cell_in(free_.geometry, position);
    for (std::size_t i = 0; i < std::size(kAround); i += 2) {
      const Eigen::Vector2i beside = cell + Eigen::Vector2i(kAround[i][0], kAround[i][1]);
      if (free_.geometry.contains(beside) && parts(position, position_in(free_.geometry, beside)))
        return true;
    }
    return false;
  }

 private:
  bool may_pass(int position) const {
    return free_.has(position) && field_.at(position) >= clearance_m_ &&
           field_.nearest[static_cast<std::size_t>(position)] != kNoCell;
  }

  bool parts(int position, int beside) const {
    const auto site = [&](int p) {
      return cell_in(free_.geometry, field_.nearest[static_cast<std::size_t>(p)]);
    };
    const double apart_m =
        (site(position) - site(beside)).cast<double>().norm() * free_.geometry.cell_size_m;
    // Both cells of a border would make a line two wide; the one farther from obstacles stays.
    return apart_m >= 2.0 * clearance_m_ && field_.at(position) >= field_.at(beside);
  }

  CellMask free_;
  DistanceField2D field_;
  double clearance_m_;
};

// Whether the set keeps its topology, and a line its end, without the cell.
bool can_go(const CellMask& lines, int cell) {
  const std::array<bool, 8> around = neighbours_of(lines, cell);
  return lines.has(cell) && std::ranges::count(around, true) >= 2 && pieces_meeting(around) == 1;
}

// Takes a layer of cells off one side of the lines. What belongs to the layer is settled before the
// first cell goes; otherwise a line two cells wide would be eaten up from its end.
bool thin_from(const int (&side)[2], CellMask& lines) {
  std::vector<int> layer;
  for (int i = 0; i < cell_count(lines.geometry); ++i) {
    const Eigen::Vector2i beside = cell_in(lines.geometry, i) + Eigen::Vector2i(side[0], side[1]);
    if (can_go(lines, i) && !lines.contains(beside)) layer.push_back(i);
  }
  bool changed = false;
  for (const int cell : layer) {
    if (!can_go(lines, cell)) continue;
    lines.set(cell, false);
    changed = true;
  }
  return changed;
}

void thin(CellMask& lines) {
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t side = 0; side < std::size(kAround); side += 2)
      changed = thin_from(kAround[side], lines) || changed;
  }
}

}  // namespace

VoronoiGraph voronoi_graph(const OccupancyGrid2D& map, double robot_radius_m) {
  const Ridges ridges(map, robot_radius_m);
  VoronoiGraph graph{empty_mask(map.geometry), {}};
  for (int i = 0; i < cell_count(map.geometry); ++i) graph.lines.set(i, ridges.is_on_ridge(i));
  thin(graph.lines);
  for (int i = 0; i < cell_count(map.geometry); ++i)
    if (graph.lines.has(i) && pieces_meeting(neighbours_of(graph.lines, i)) != 2)
      graph.nodes.push_back(i);
  return graph;
}

}  // namespace stereovox
