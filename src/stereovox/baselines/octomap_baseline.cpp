#include "stereovox/baselines/octomap_baseline.h"

#include <octomap/OcTree.h>

#include <algorithm>

namespace stereovox {
namespace {

// Keeps a voxel's border from touching the next cell by rounding; in voxels.
constexpr double kBorder = 1e-6;

octomap::Pointcloud cloud_of(const DisparityImage& disparity, const RectifiedCamera& camera,
                             const SE3& T_world_camera, int pixel_step) {
  octomap::Pointcloud cloud;
  for (int v = 0; v < disparity.height(); v += pixel_step)
    for (int u = 0; u < disparity.width(); u += pixel_step) {
      const double d = disparity.disparity_px(v, u);
      if (!(d > 0.0)) continue;
      const Eigen::Vector3f p = (T_world_camera * triangulate(camera, u, v, d)).cast<float>();
      cloud.push_back(p.x(), p.y(), p.z());
    }
  return cloud;
}

void mark(OccupancyGrid2D& grid, const Eigen::Vector2i& cell, CellLabel label, float state) {
  if (!grid.geometry.contains(cell)) return;
  const std::size_t position = grid.position_of(cell);
  if (grid.labels[position] > label) return;  // unknown < free < occupied
  const bool is_raised = grid.labels[position] < label;
  grid.states[position] = is_raised ? state : std::max(grid.states[position], state);
  grid.labels[position] = label;
}

}  // namespace

void OctomapBaselineParams::describe(ParameterList& list) {
  list("voxel_size_m", voxel_size_m, {0.01, 1}, "edge of a voxel");
  list("max_range_m", max_range_m, {0.5, 100}, "farther points only clear, up to this range");
  list("hit_probability", hit_probability, {0.5, 0.99}, "occupancy that one hit gives a voxel");
  list("miss_probability", miss_probability, {0.01, 0.5}, "occupancy that one miss gives a voxel");
  list("min_probability", min_probability, {0.001, 0.5}, "lower clamp of a voxel's occupancy");
  list("max_probability", max_probability, {0.5, 0.999}, "upper clamp of a voxel's occupancy");
  list("pixel_step", pixel_step, {1, 64}, "every so many columns and rows give points");
  list("min_height_m", min_height_m, {-10, 100}, "lower end of the height band, above the floor");
  list("max_height_m", max_height_m, {-10, 100}, "upper end of the height band, above the floor");
}

OctomapBaseline::OctomapBaseline(const OctomapBaselineParams& params)
    : params_(params), tree_(std::make_unique<octomap::OcTree>(params.voxel_size_m)) {
  tree_->setProbHit(params.hit_probability);
  tree_->setProbMiss(params.miss_probability);
  tree_->setClampingThresMin(params.min_probability);
  tree_->setClampingThresMax(params.max_probability);
}

OctomapBaseline::~OctomapBaseline() = default;
OctomapBaseline::OctomapBaseline(OctomapBaseline&&) noexcept = default;
OctomapBaseline& OctomapBaseline::operator=(OctomapBaseline&&) noexcept = default;

void OctomapBaseline::integrate(const DisparityImage& disparity, const RectifiedCamera& camera,
                                const SE3& T_world_camera) {
  const Eigen::Vector3f origin = T_world_camera.translation.cast<float>();
  tree_->insertPointCloud(cloud_of(disparity, camera, T_world_camera, params_.pixel_step),
                          {origin.x(), origin.y(), origin.z()}, params_.max_range_m);
}

OccupancyGrid2D OctomapBaseline::map(const GridGeometry& geometry, double floor_z_m) const {
  OccupancyGrid2D grid = unknown_grid(geometry, "octomap");
  const double low_m = floor_z_m + params_.min_height_m, high_m = floor_z_m + params_.max_height_m;
  // A leaf may be larger than a voxel: equal ones are merged.
  for (auto leaf = tree_->begin_leafs(); leaf != tree_->end_leafs(); ++leaf) {
    const double half_m = 0.5 * leaf.getSize();
    if (leaf.getZ() + half_m <= low_m || leaf.getZ() - half_m >= high_m) continue;
    const Eigen::Vector2d center(leaf.getX(), leaf.getY());
    const Eigen::Vector2d inner =
        Eigen::Vector2d::Constant(half_m - kBorder * params_.voxel_size_m);
    const Eigen::Vector2i first = index_of(geometry, center - inner);
    const Eigen::Vector2i last = index_of(geometry, center + inner);
    const CellLabel label = tree_->isNodeOccupied(*leaf) ? CellLabel::occupied : CellLabel::free;
    for (int y = first.y(); y <= last.y(); ++y)
      for (int x = first.x(); x <= last.x(); ++x)
        mark(grid, {x, y}, label, static_cast<float>(leaf->getOccupancy()));
  }
  return grid;
}

}  // namespace stereovox
