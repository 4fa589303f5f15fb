// OctoMap as its users run it (Hornung et al. 2013; liboctomap and octomap_server): every disparity
// a point, every point a ray, the library's own sensor model, and its server's projection to 2D.
#pragma once

#include <memory>

#include "stereovox/core/camera.h"
#include "stereovox/core/image.h"
#include "stereovox/core/parameters.h"
#include "stereovox/core/se3.h"
#include "stereovox/navmap/occupancy_grid_2d.h"

namespace octomap {
class OcTree;
}

namespace stereovox {

// Defaults are those of the library and, for the range, of method.md C.0.
struct OctomapBaselineParams {
  static constexpr const char* kName = "octomap";

  double voxel_size_m = 0.05;
  double max_range_m = 5.0;
  double hit_probability = 0.7;
  double miss_probability = 0.4;
  double min_probability = 0.1192, max_probability = 0.971;
  int pixel_step = 1;
  double min_height_m = 0.15, max_height_m = 1.5;

  void describe(ParameterList& list);
};

class OctomapBaseline {
 public:
  explicit OctomapBaseline(const OctomapBaselineParams& params);
  ~OctomapBaseline();
  OctomapBaseline(OctomapBaseline&&) noexcept;
  OctomapBaseline& operator=(OctomapBaseline&&) noexcept;

  // Points farther than max_range_m clear the space up to it and mark nothing.
  void integrate(const DisparityImage& disparity, const RectifiedCamera& camera,
                 const SE3& T_world_camera);

  // A cell is occupied when an occupied voxel touches it and the height band above the floor, else
  // free when a free one does, else unknown. The state is the largest occupancy of the voxels that
  // gave the label. Throws Error when the grid has no cells or too many.
  OccupancyGrid2D map(const GridGeometry& geometry, double floor_z_m) const;

 private:
  OctomapBaselineParams params_;
  std::unique_ptr<octomap::OcTree> tree_;
};

}  // namespace stereovox
