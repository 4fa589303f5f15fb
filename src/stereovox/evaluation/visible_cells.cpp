#include "stereovox/evaluation/visible_cells.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "stereovox/core/error.h"
#include "stereovox/occupancy/voxel_ray.h"

namespace stereovox {
namespace {

constexpr double kMaxRange_m = 1000.0;

void require_possible(double fov_rad, double max_range_m) {
  if (!(fov_rad > 0.0 && fov_rad <= 2.0 * std::numbers::pi))
    throw UsageError(fmt::format("field of view: {} rad is outside (0, 2 pi]", fov_rad));
  if (!(max_range_m > 0.0 && max_range_m <= kMaxRange_m))
    throw UsageError(
        fmt::format("range of view: {} m is outside (0, {}]", max_range_m, kMaxRange_m));
}

void mark_ray(const OccupancyGrid2D& plan, const Eigen::Vector2d& from_m,
              const Eigen::Vector2d& to_m, CellMask& visible) {
  const auto on_plane = [&](const Eigen::Vector2d& p_m) {
    const Eigen::Vector2d p = p_m - plan.geometry.origin_m;
    return Eigen::Vector3d(p.x(), p.y(), 0.0);
  };
  bool goes_on = true;
  const auto visit = [&](const Eigen::Vector3i& voxel) {
    const Eigen::Vector2i cell = voxel.head<2>();
    goes_on = goes_on && plan.geometry.contains(cell);
    if (!goes_on) return;
    visible.set(position_in(plan.geometry, cell));
    goes_on = plan.label_at(cell) != CellLabel::occupied;
  };
  for_each_voxel_on_segment(on_plane(from_m), on_plane(to_m), plan.geometry.cell_size_m, visit);
}

}  // namespace

CellMask visible_cells(const OccupancyGrid2D& plan, std::span<const ViewPose> poses, double fov_rad,
                       double max_range_m) {
  require_possible(fov_rad, max_range_m);
  CellMask visible = empty_mask(plan.geometry);
  const int steps =
      static_cast<int>(std::ceil(2.0 * fov_rad * max_range_m / plan.geometry.cell_size_m));
  for (const ViewPose& pose : poses)
    for (int i = 0; i <= steps; ++i) {
      const double angle_rad = pose.heading_rad + fov_rad * (static_cast<double>(i) / steps - 0.5);
      const Eigen::Vector2d way_m(std::cos(angle_rad), std::sin(angle_rad));
      mark_ray(plan, pose.position_m, pose.position_m + max_range_m * way_m, visible);
    }
  return visible;
}

}  // namespace stereovox
