#include "stereovox/evaluation/ideal_map.h"

#include <fmt/format.h>

#include <algorithm>

#include "stereovox/core/error.h"
#include "stereovox/evaluation/value_grid.h"
#include "stereovox/navmap/connected_cells.h"

namespace stereovox {
namespace {

CellMask reachable_cells(const OccupancyGrid2D& plan, std::optional<Eigen::Vector2d> start_m) {
  const CellMask free = cells_labelled(plan, CellLabel::free);
  if (std::ranges::count(free.cells, 1) == 0) throw Error("ideal map: has no free cell");
  if (!start_m) return largest_piece(free);
  const Eigen::Vector2i start = index_of(plan.geometry, *start_m);
  if (!free.contains(start))
    throw Error(fmt::format("ideal map: the start ({:g}, {:g}) m is on no free cell", start_m->x(),
                            start_m->y()));
  return piece_around(free, start);
}

bool has_neighbour_in(const CellMask& mask, const Eigen::Vector2i& cell) {
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx)
      if (mask.contains(cell + Eigen::Vector2i(dx, dy))) return true;
  return false;
}

void set_cell(OccupancyGrid2D& map, std::size_t i, CellLabel label) {
  map.labels[i] = label;
  map.states[i] = label == CellLabel::occupied ? 1.0F : 0.0F;
}

OccupancyGrid2D normalised(const OccupancyGrid2D& plan, const CellMask& reachable) {
  OccupancyGrid2D map = unknown_grid(plan.geometry, "ideal map");
  for (int i = 0; i < cell_count(plan.geometry); ++i) {
    const auto position = static_cast<std::size_t>(i);
    const bool is_wall = plan.labels[position] == CellLabel::occupied;
    if (reachable.has(i)) set_cell(map, position, CellLabel::free);
    if (is_wall && has_neighbour_in(reachable, cell_in(plan.geometry, i)))
      set_cell(map, position, CellLabel::occupied);
  }
  return map;
}

}  // namespace

IdealMap make_ideal(const OccupancyGrid2D& plan, std::optional<Eigen::Vector2d> start_m) {
  OccupancyGrid2D theoretical = unknown_grid(plan.geometry, "ideal map");
  for (std::size_t i = 0; i < plan.labels.size(); ++i)
    set_cell(theoretical, i,
             plan.labels[i] == CellLabel::occupied ? CellLabel::occupied : CellLabel::free);
  return {std::move(theoretical), normalised(plan, reachable_cells(plan, start_m))};
}

IdealMap restricted_to(const IdealMap& ideal, const CellMask& visible) {
  IdealMap result = ideal;
  for (std::size_t i = 0; i < result.normalised.labels.size(); ++i)
    if (visible.cells[i] == 0) set_cell(result.normalised, i, CellLabel::unknown);
  return result;
}

IdealMap extended_to(const IdealMap& ideal, const GridGeometry& region) {
  return {extended_to(ideal.theoretical, region), extended_to(ideal.normalised, region)};
}

OccupancyGrid2D planning_map(const IdealMap& ideal) {
  OccupancyGrid2D map = ideal.normalised;
  for (std::size_t i = 0; i < map.labels.size(); ++i)
    if (ideal.theoretical.labels[i] == CellLabel::occupied) set_cell(map, i, CellLabel::occupied);
  return map;
}

}  // namespace stereovox
