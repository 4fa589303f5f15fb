// One frame as seen by the map: which pixel says what, which space a ray may clear, which voxels
// are in view. The fast and the plain integration share these definitions and nothing else.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "stereovox/core/camera.h"
#include "stereovox/core/grid_geometry.h"
#include "stereovox/core/image.h"
#include "stereovox/core/se3.h"
#include "stereovox/occupancy/occupancy_params.h"
#include "stereovox/occupancy/voxel_map.h"

namespace stereovox {

// Every how many pixels and rows the image is read: for surfaces, and for rays that clear space.
struct SamplingSteps {
  int surface_px = 1, ray_px = 1;
};

// The parameters with the limits set that they leave open (0). Cameras whose lines of sight part
// widely measure farther: such a range ends where disparities become small (8 px for surfaces, 13
// for free space) or errors exceed max_sigma_m(), for free space two voxels. The ranges for a small
// robot's camera indoors, 8 and 5 m, are the least. max_sigma_m becomes the error of half a pixel
// at 4 m, or of a quarter of one where disparities are 11 px.
OccupancyParams with_ranges(const OccupancyParams& params, const RectifiedCamera& camera);

// How far along each axis a camera may be from the origin of a map, so that all that it may touch
// lies on the lattice. For params of with_ranges.
double farthest_camera_m(const OccupancyParams& params);

// As the parameters say, or where they leave it open (0): rays about one voxel apart at the
// farthest distance that they clear, and surfaces read twice as densely, but not so sparsely that
// thin things are missed.
SamplingSteps sampling_steps(const OccupancyParams& params, const RectifiedCamera& camera);

// The rows of an image that are read with these steps.
std::vector<int> rows_read(const SamplingSteps& steps, int height);

// Refers to the image and the camera that it was made from.
struct FrameView {
  const DisparityImage& disparity;
  const RectifiedCamera& camera;
  OccupancyParams params;  // with_ranges
  SamplingSteps steps;
  // Of the update rule; nullptr when surfaces are observed by params.observation.
  const SurfaceProfile* profile = nullptr;
  SE3 T_world_camera, T_camera_world;
  MeasuringFrame measuring;
  std::uint32_t stamp_ms = 0;       // since the map's epoch
  double min_z_m = 0, max_z_m = 0;  // height limits in the world
};

struct Segment {
  Eigen::Vector3d from, to;
};

// If the parameters say so, the map learns where the floor lies from a frame that is to be
// integrated. To be called before view_frame, which takes the height limits from there.
void observe_floor(const DisparityImage& disparity, const RectifiedCamera& camera,
                   const SE3& T_world_camera, const OccupancyParams& params, VoxelMap& map);

// Checks that the frame fits the map and sets the map's epoch if it is the first one. Throws Error
// when the voxel sizes differ, the time stamp is before the epoch or more than 49 days after it, or
// the view leaves the lattice; std::logic_error when image and camera differ in size or the pose is
// not finite.
FrameView view_frame(const DisparityImage& disparity, const RectifiedCamera& camera,
                     const SE3& T_world_camera, std::int64_t stamp_ns,
                     const OccupancyParams& params, VoxelMap& map);

// First pixel, in each direction, of those taken at every `step`-th.
inline int first_sample(int step) { return step / 2; }

// What pixel (u, v) measures; nothing when it has no disparity or a nonsensical one, or the point
// is nearer than min_depth_m or below the lowest height.
std::optional<PointMeasurement> measure_pixel(const FrameView& frame, int u, int v);

// Measurements whose range has a larger error only clear space. Needs the limits set.
double max_sigma_m(const OccupancyParams& params);

// Whether the point is certain, near and low enough to mark a surface; if not, it only clears.
bool marks_surface(const FrameView& frame, const PointMeasurement& point);

// Whether the error of the point's range is below half a voxel's edge, so that it mostly lies in
// the voxel it should.
bool is_exact(const FrameView& frame, const PointMeasurement& point);

// How long before a point its ray ceases to clear space: max(r, sigmas * max(sigma, min_sigma_m)),
// which is k_f sigma, or up to where the profile of the update rule begins.
struct FreeMargin {
  double sigmas = 0, min_sigma_m = 0, half_voxel_m = 0;

  [[gnu::always_inline]] double of(double sigma_range_m) const {
    const double floored_m = sigma_range_m > min_sigma_m ? sigma_range_m : min_sigma_m;
    const double margin_m = sigmas * floored_m;
    return margin_m > half_voxel_m ? margin_m : half_voxel_m;
  }
};
FreeMargin free_margin(const FrameView& frame);

// The part of the ray to the point that is known to be free: up to the free margin before the
// point, not farther than max_clearing_m, within the height limits.
std::optional<Segment> free_segment(const FrameView& frame, const PointMeasurement& point);

// The same along the ray of pixel (u, v), whatever the heights, in metres from the camera; 0 when
// nothing is free.
float free_end_m(const FrameView& frame, int u, int v);

// The part of the ray that the profile speaks of beyond the free one, within the height limits.
std::optional<Segment> profile_segment(const FrameView& frame, const PointMeasurement& point);

// N_exp of eq. (13): how many measured pixels a face of a voxel would send, seen frontally.
class ExpectedPoints {
 public:
  explicit ExpectedPoints(const FrameView& frame);

  double from(const Eigen::Vector3i& voxel) const {
    const double depth_m = forward_.dot(voxel_center_of(voxel_size_m_, voxel) - camera_m_);
    const double z_m = std::max(depth_m, min_depth_m_);
    return at_one_metre_ / (z_m * z_m);
  }

 private:
  double voxel_size_m_, min_depth_m_, at_one_metre_;
  Eigen::Vector3d camera_m_, forward_;
};

// Where the ray to the point runs inside this voxel, in metres from the camera; end < begin when it
// misses the voxel. `inverse_ray` holds 1 / ray_world.
Chord chord_in(const FrameView& frame, const Eigen::Vector3d& inverse_ray,
               const Eigen::Vector3i& voxel);

// Whether the voxel's centre is within image, depth limits and height limits.
bool is_in_frustum(const FrameView& frame, const Eigen::Vector3i& voxel);

// Voxels outside these bounds are not in the frustum; min > max when it is empty.
VoxelBounds frustum_bounds(const FrameView& frame);

}  // namespace stereovox
