#include "stereovox/simulation/ideal.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "stereovox/core/error.h"

namespace stereovox {
namespace {

constexpr std::int64_t kMaxElements = 64'000'000;
// Sizes of walls and cells are decimal fractions; their quotients are not exact.
constexpr double kRounding = 1e-9;

int first_index(double from_m, double size_m) {
  return static_cast<int>(std::floor(from_m / size_m + kRounding));
}
int end_index(double to_m, double size_m) {
  return static_cast<int>(std::ceil(to_m / size_m - kRounding));
}

void check_count(std::int64_t count, double size_m) {
  if (count > kMaxElements)
    throw UsageError(fmt::format("cells of {} m: the world has {} of them, at most {} are allowed",
                                 size_m, count, kMaxElements));
}

GridGeometry geometry_of(const World& world, double cell_size_m) {
  const Eigen::Vector2i min(first_index(world.min_m.x(), cell_size_m),
                            first_index(world.min_m.y(), cell_size_m));
  const Eigen::Vector2i end(end_index(world.max_m.x(), cell_size_m),
                            end_index(world.max_m.y(), cell_size_m));
  check_count(static_cast<std::int64_t>(end.x() - min.x()) * (end.y() - min.y()), cell_size_m);
  return {.origin_m = min.cast<double>() * cell_size_m,
          .cell_size_m = cell_size_m,
          .width = end.x() - min.x(),
          .height = end.y() - min.y()};
}

// The least area of a base that must lie in a cell.
double least_area_m2(const Polygon2D& base, double cell_size_m) {
  const Eigen::Vector2d extents = extents_m(base);
  return kMinOverlap * std::min(extents.x(), cell_size_m) * std::min(extents.y(), cell_size_m);
}

// Calls use(cell) for each cell of the grid that the base counts for.
template <class Use>
void for_each_cell(const Polygon2D& base, const GridGeometry& grid, Use use) {
  if (base.empty()) return;
  Eigen::Vector2d low = base[0], high = base[0];
  for (const Eigen::Vector2d& corner : base) {
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  const double least = least_area_m2(base, grid.cell_size_m);
  const Eigen::Vector2i last = index_of(grid, high);
  for (int y = index_of(grid, low).y(); y <= last.y(); ++y)
    for (int x = index_of(grid, low).x(); x <= last.x(); ++x) {
      const Eigen::Vector2i cell(x, y);
      if (!grid.contains(cell)) continue;
      const Eigen::Vector2d corner = grid.origin_m + cell.cast<double>() * grid.cell_size_m;
      const Eigen::Vector2d opposite = corner + Eigen::Vector2d::Constant(grid.cell_size_m);
      if (area_m2(clipped(base, corner, opposite)) >= least) use(cell);
    }
}

// Whether enough of the solid's height lies in the layer.
bool fills_layer(const Prism& solid, double low_m, double high_m) {
  double top = solid.top_m;
  for (const Eigen::Vector2d& corner : solid.base_m) top = std::max(top, solid.top_at_m(corner));
  const double overlap = std::min(top, high_m) - std::max(solid.bottom_m, low_m);
  return overlap >= kMinOverlap * std::min(top - solid.bottom_m, high_m - low_m);
}

}  // namespace

OccupiedCells occupied_cells(const World& world, double cell_size_m, const HeightBand& band) {
  OccupiedCells cells{geometry_of(world, cell_size_m), {}};
  const auto width = static_cast<std::size_t>(cells.geometry.width);
  cells.is_occupied.resize(width * static_cast<std::size_t>(cells.geometry.height));
  for (const Prism& solid : world.solids)
    for_each_cell(base_between(solid, band.min_m, band.max_m), cells.geometry,
                  [&](const Eigen::Vector2i& cell) {
                    cells.is_occupied[static_cast<std::size_t>(cell.y()) * width +
                                      static_cast<std::size_t>(cell.x())] = 1;
                  });
  return cells;
}

OccupiedVoxels occupied_voxels(const World& world, double voxel_size_m, const HeightBand& band) {
  const GridGeometry grid = geometry_of(world, voxel_size_m);
  const int bottom = first_index(band.min_m, voxel_size_m);
  const int top = end_index(band.max_m, voxel_size_m);
  check_count(static_cast<std::int64_t>(grid.width) * grid.height * (top - bottom), voxel_size_m);
  const Eigen::Vector2i origin = (grid.origin_m / voxel_size_m).array().round().cast<int>();
  OccupiedVoxels voxels{
      voxel_size_m, {origin.x(), origin.y(), bottom}, {grid.width, grid.height, top - bottom}, {}};
  voxels.is_occupied.resize(static_cast<std::size_t>(voxels.size.prod()));
  for (const Prism& solid : world.solids)
    for (int z = bottom; z < top; ++z) {
      if (!fills_layer(solid, z * voxel_size_m, (z + 1) * voxel_size_m)) continue;
      for_each_cell(base_between(solid, z * voxel_size_m, (z + 1) * voxel_size_m), grid,
                    [&](const Eigen::Vector2i& cell) {
                      const Eigen::Vector3i index(origin.x() + cell.x(), origin.y() + cell.y(), z);
                      voxels.is_occupied[voxels.position_of(index)] = 1;
                    });
    }
  return voxels;
}

}  // namespace stereovox
