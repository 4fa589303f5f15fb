#include "stereovox/evaluation/value_grid.h"

#include <fmt/format.h>

#include <cmath>

#include "stereovox/core/error.h"

namespace stereovox {
namespace {

constexpr double kSizeTolerance = 1e-6;    // relative
constexpr double kOffsetTolerance = 1e-3;  // cells
constexpr double kFarthest_cells = 1e9;    // so that offsets are ints

double value_of(CellLabel label, double state, MapForm form) {
  if (label == CellLabel::unknown) return kUnknownValue;
  if (form == MapForm::graded) return state;
  return label == CellLabel::occupied ? 1.0 : 0.0;
}

void require_same_cell_size(const GridGeometry& a, const GridGeometry& b) {
  if (!have_same_cell_size(a, b))
    throw Error(fmt::format("maps: cells of {:.9g} m and of {:.9g} m cannot be compared",
                            a.cell_size_m, b.cell_size_m));
}

void copy_cell(const OccupancyGrid2D& from, const Eigen::Vector2i& at, OccupancyGrid2D& to,
               const Eigen::Vector2i& there) {
  if (!from.geometry.contains(at)) return;
  to.labels[to.position_of(there)] = from.labels[from.position_of(at)];
  to.states[to.position_of(there)] = from.states[from.position_of(at)];
}

GridGeometry checked(const GridGeometry& lattice, const Eigen::Array2d& first,
                     const Eigen::Array2d& end) {
  const Eigen::Array2d size = end - first;
  if (size.prod() > static_cast<double>(kMaxCells))
    throw Error(fmt::format("maps: together they stretch over {:.0f} x {:.0f} cells, at most {}",
                            size.x(), size.y(), kMaxCells));
  return {lattice.origin_m + first.matrix() * lattice.cell_size_m, lattice.cell_size_m,
          static_cast<int>(size.x()), static_cast<int>(size.y())};
}

}  // namespace

std::span<const std::string> names_of(MapForm) {
  static const std::vector<std::string> names = {"ternary", "graded"};
  return names;
}

ValueGrid value_grid(const OccupancyGrid2D& map, MapForm form) {
  ValueGrid grid{map.geometry, std::vector<double>(map.labels.size())};
  for (std::size_t i = 0; i < grid.values.size(); ++i)
    grid.values[i] = value_of(map.labels[i], map.states[i], form);
  return grid;
}

Eigen::Vector2i lattice_offset(const GridGeometry& a, const GridGeometry& b) {
  require_same_cell_size(a, b);
  const Eigen::Array2d offset = (b.origin_m - a.origin_m).array() / a.cell_size_m;
  if (!(offset.abs() <= kFarthest_cells).all())
    throw Error(
        fmt::format("maps: the origins lie ({:g}, {:g}) cells apart", offset.x(), offset.y()));
  if (((offset - offset.round()).abs() > kOffsetTolerance).any())
    throw Error(fmt::format("maps: the origins lie ({:.6g}, {:.6g}) cells apart, not whole cells",
                            offset.x(), offset.y()));
  return offset.round().cast<int>();
}

GridGeometry union_of(const GridGeometry& a, const GridGeometry& b) {
  const Eigen::Array2d offset = lattice_offset(a, b).cast<double>();
  const Eigen::Array2d first = offset.min(0.0);
  const Eigen::Array2d end =
      (offset + Eigen::Array2d(b.width, b.height)).max(Eigen::Array2d(a.width, a.height));
  return checked(a, first, end);
}

OccupancyGrid2D extended_to(const OccupancyGrid2D& map, const GridGeometry& region) {
  const Eigen::Vector2i offset = lattice_offset(map.geometry, region);
  OccupancyGrid2D result = unknown_grid(region, "maps");
  for (int y = 0; y < region.height; ++y)
    for (int x = 0; x < region.width; ++x)
      copy_cell(map, offset + Eigen::Vector2i(x, y), result, {x, y});
  return result;
}

bool have_same_cell_size(const GridGeometry& a, const GridGeometry& b) {
  return std::abs(a.cell_size_m - b.cell_size_m) <= kSizeTolerance * a.cell_size_m;
}

OccupancyGrid2D resampled_to(const OccupancyGrid2D& map, const GridGeometry& lattice) {
  const Eigen::Vector2d size_m =
      Eigen::Vector2d(map.geometry.width, map.geometry.height) * map.geometry.cell_size_m;
  const auto in_cells = [&](const Eigen::Vector2d& p_m) {
    return Eigen::Array2d((p_m - lattice.origin_m) / lattice.cell_size_m);
  };
  // A hair inside, so that maps of equal cells keep their extent.
  const Eigen::Array2d first = (in_cells(map.geometry.origin_m) + kOffsetTolerance).floor();
  const Eigen::Array2d end = (in_cells(map.geometry.origin_m + size_m) - kOffsetTolerance).ceil();
  OccupancyGrid2D result = unknown_grid(checked(lattice, first, end), "resampled map");
  for (int y = 0; y < result.geometry.height; ++y)
    for (int x = 0; x < result.geometry.width; ++x)
      copy_cell(map, index_of(map.geometry, center_of(result.geometry, {x, y})), result, {x, y});
  return result;
}

}  // namespace stereovox
