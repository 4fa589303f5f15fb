#include "stereovox/navmap/project_to_2d.h"

#include <limits>
#include <vector>

#include "stereovox/navmap/column_states.h"
#include "stereovox/navmap/hidden_cells.h"
#include "stereovox/navmap/thin_walls.h"

namespace stereovox {
namespace {

struct CellBounds {
  Eigen::Vector2i min = Eigen::Vector2i::Constant(std::numeric_limits<int>::max());
  Eigen::Vector2i max = Eigen::Vector2i::Constant(std::numeric_limits<int>::min());

  void add(const Eigen::Vector2i& cell) {
    min = min.cwiseMin(cell);
    max = max.cwiseMax(cell);
  }
  bool is_empty() const { return min.x() > max.x(); }
};

CellBounds bounds_of(const VoxelMap& map, const SightLines& sight_lines, NavmapParams params) {
  params.min_observations = 1;  // seldom observed is still part of the map, as unknown
  CellBounds bounds;
  for_each_column_tile(map, params, [&](const TileIndex& index, const ColumnTile& columns) {
    for (int i = 0; i < kCellsPerTile; ++i)
      if (columns[static_cast<std::size_t>(i)].is_known) bounds.add(cell_at(index, i));
  });
  for_each_cell(sight_lines.free_cells(), [&](const Eigen::Vector2i& cell) { bounds.add(cell); });
  return bounds;
}

GridGeometry geometry_of(const CellBounds& bounds, double cell_size_m) {
  if (bounds.is_empty()) return {Eigen::Vector2d::Zero(), cell_size_m, 1, 1};
  const Eigen::Vector2i size = bounds.max - bounds.min + Eigen::Vector2i::Ones();
  return {bounds.min.cast<double>() * cell_size_m, cell_size_m, size.x(), size.y()};
}

CellLabel label_of(const ColumnState& column, bool is_held, const NavmapParams& params) {
  if (is_occupied(column, is_held, params)) return CellLabel::occupied;
  const bool is_seen_free = column.is_known && column.max_state < params.free_threshold;
  return is_seen_free && params.label_rule == LabelRule::visible ? CellLabel::free
                                                                 : CellLabel::unknown;
}

}  // namespace

OccupancyGrid2D project_to_2d(const VoxelMap& map, const SightLines& sight_lines,
                              const NavmapParams& params, const WallFaces& faces) {
  validate(params);
  const CellBounds bounds = bounds_of(map, sight_lines, params);
  OccupancyGrid2D grid = unknown_grid(geometry_of(bounds, map.voxel_size_m()), "map");

  for_each_column_tile(map, params, [&](const TileIndex& index, const ColumnTile& columns) {
    for (int i = 0; i < kCellsPerTile; ++i) {
      const ColumnState& column = columns[static_cast<std::size_t>(i)];
      if (!column.is_known) continue;
      const Eigen::Vector2i cell = cell_at(index, i);
      const std::size_t position = grid.position_of(cell - bounds.min);
      grid.states[position] = column.max_state;
      grid.labels[position] = label_of(column, sight_lines.held_cells().contains(cell), params);
    }
  });
  for_each_cell(sight_lines.free_cells(), [&](const Eigen::Vector2i& cell) {
    CellLabel& label = grid.labels[grid.position_of(cell - bounds.min)];
    if (label == CellLabel::unknown) label = CellLabel::free;
  });
  std::vector<std::size_t> doubtful;
  if (params.thins_walls()) doubtful = thin_walls(grid, faces, params);
  if (params.hidden_cells == HiddenCells::unknown) forget_hidden_cells(grid);
  for (const std::size_t position : doubtful) grid.labels[position] = CellLabel::unknown;
  return grid;
}

}  // namespace stereovox
