#include "stereovox/occupancy/frame_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "stereovox/core/error.h"

namespace stereovox {
namespace {

constexpr std::int64_t kNanosecondsPerMillisecond = 1'000'000;

void check_caller(const DisparityImage& disparity, const RectifiedCamera& camera,
                  const SE3& T_world_camera) {
  if (disparity.width() != camera.pinhole.width || disparity.height() != camera.pinhole.height ||
      disparity.sigma_px.size() != disparity.disparity_px.size())
    throw std::logic_error("integrate: the disparity image has another size than the camera");
  if (!is_finite(T_world_camera)) throw std::logic_error("integrate: the pose is not finite");
}

// Farthest distance from the camera at which a frame can touch a voxel.
double reach_m(const OccupancyParams& params) {
  constexpr double kCornerByAxis = 4.0;  // rays into image corners are longer than their depth
  return kCornerByAxis * std::max(params.max_depth_m, params.max_clearing_m);
}

void check_reach(const SE3& T_world_camera, const OccupancyParams& params) {
  const double limit_m = farthest_camera_m(params);
  const Eigen::Vector3d& p = T_world_camera.translation;
  if (p.cwiseAbs().maxCoeff() > limit_m)
    throw Error(
        fmt::format("camera at ({:.0f}, {:.0f}, {:.0f}) m is beyond the map's limit of "
                    "{:.0f} m from the origin",
                    p.x(), p.y(), p.z(), limit_m));
}

std::uint32_t stamp_in_map_ms(std::int64_t stamp_ns, VoxelMap& map) {
  if (!map.epoch_ns) map.epoch_ns = stamp_ns;
  const std::int64_t stamp_ms = (stamp_ns - *map.epoch_ns) / kNanosecondsPerMillisecond;
  if (stamp_ns < *map.epoch_ns || stamp_ms > std::numeric_limits<std::uint32_t>::max())
    throw Error(
        fmt::format("frame at {} ns does not lie within 49 days after the map's first frame "
                    "at {} ns",
                    stamp_ns, *map.epoch_ns));
  return static_cast<std::uint32_t>(stamp_ms);
}

bool is_measured(float disparity_px, float sigma_px) {
  return disparity_px > 0.0F && std::isfinite(disparity_px) && sigma_px >= 0.0F &&
         std::isfinite(sigma_px);
}

double free_end_m(const FrameView& frame, const PointMeasurement& point) {
  const double end_m = point.range_m - free_margin(frame).of(point.sigma_range_m);
  return std::min(end_m, frame.params.max_clearing_m);
}

// The part of this stretch of the ray that lies within the height limits.
std::optional<Segment> within_heights(const FrameView& frame, const PointMeasurement& point,
                                      Chord stretch) {
  const double camera_z_m = frame.T_world_camera.translation.z();
  const double rise = point.ray_world.z();
  if (rise != 0.0) {
    const auto [in_m, out_m] =
        std::minmax({(frame.min_z_m - camera_z_m) / rise, (frame.max_z_m - camera_z_m) / rise});
    stretch.begin_m = std::max(stretch.begin_m, in_m);
    stretch.end_m = std::min(stretch.end_m, out_m);
  } else if (camera_z_m < frame.min_z_m || camera_z_m > frame.max_z_m) {
    return std::nullopt;
  }
  if (!(stretch.begin_m < stretch.end_m)) return std::nullopt;
  return Segment{frame.T_world_camera.translation + stretch.begin_m * point.ray_world,
                 frame.T_world_camera.translation + stretch.end_m * point.ray_world};
}

// The error of half a pixel at 4 m, so that weak cameras see across a room, or of a quarter of a
// pixel where disparities are 11 px, which is farther away for wide rigs. At least 12.8 cm.
double largest_sigma_m(const RectifiedCamera& camera) {
  constexpr double kRoom_m = 4.0, kErrorInRoom_px = 0.5;
  constexpr double kLeast_px = 11.0, kErrorAtLeast_px = 0.25;
  const auto sigma_m = [&](double depth_m, double sigma_px) {
    return depth_m * depth_m / camera.depth_m(sigma_px);
  };
  return std::max(sigma_m(kRoom_m, kErrorInRoom_px),
                  sigma_m(camera.depth_m(kLeast_px), kErrorAtLeast_px));
}

}  // namespace

double farthest_camera_m(const OccupancyParams& params) {
  return params.voxel_size_m * kBlockSide * (kMaxBlockCoordinate - kBlockSide) - reach_m(params);
}

OccupancyParams with_ranges(const OccupancyParams& params, const RectifiedCamera& camera) {
  constexpr double kLeastDepth_m = 8.0, kLeastClearing_m = 5.0;
  constexpr double kLeastOfSurface_px = 8.0, kLeastOfFreeSpace_px = 13.0;
  constexpr double kSigmaOfFreeSpace_voxels = 2.0;
  const double sigma_px = params.error_model.min_sigma_disparity_px;
  const auto range_m = [&](double least_m, double least_px, double sigma_m) {
    const double exact_m = std::sqrt(sigma_m * camera.depth_m(sigma_px));
    return std::max(least_m, std::min(camera.depth_m(least_px), exact_m));
  };
  OccupancyParams ranged = params;
  if (params.max_sigma_m == 0.0) ranged.max_sigma_m = largest_sigma_m(camera);
  if (params.max_depth_m == 0.0)
    ranged.max_depth_m = range_m(kLeastDepth_m, kLeastOfSurface_px, max_sigma_m(ranged));
  if (params.max_clearing_m == 0.0)
    ranged.max_clearing_m = range_m(kLeastClearing_m, kLeastOfFreeSpace_px,
                                    kSigmaOfFreeSpace_voxels * params.voxel_size_m);
  return ranged;
}

SamplingSteps sampling_steps(const OccupancyParams& params, const RectifiedCamera& camera) {
  // The edge of a table or a leg is a few pixels wide, however large the voxels are.
  constexpr int kCoarsestSurface_px = 3;
  constexpr double kCoarsestRay_px = 3 * kCoarsestSurface_px;
  const double voxel_px =
      camera.pinhole.fx_px * params.voxel_size_m / with_ranges(params, camera).max_clearing_m;
  const int auto_ray_px =
      std::max(1, static_cast<int>(std::ceil(std::min(voxel_px, kCoarsestRay_px))));
  const int ray_px = params.ray_step_px > 0 ? params.ray_step_px : auto_ray_px;
  const int auto_surface_px = std::clamp(ray_px / 2, 1, kCoarsestSurface_px);
  return {params.pixel_step > 0 ? params.pixel_step : auto_surface_px, ray_px};
}

std::vector<int> rows_read(const SamplingSteps& steps, int height) {
  const auto is_sampled = [](int row, int step) { return row % step == first_sample(step); };
  std::vector<int> rows;
  for (int row = 0; row < height; ++row)
    if (is_sampled(row, steps.surface_px) || is_sampled(row, steps.ray_px)) rows.push_back(row);
  return rows;
}

void observe_floor(const DisparityImage& disparity, const RectifiedCamera& camera,
                   const SE3& T_world_camera, const OccupancyParams& params, VoxelMap& map) {
  if (!params.follow_floor) return;
  const OccupancyParams ranged = with_ranges(params, camera);
  check_caller(disparity, camera, T_world_camera);
  check_reach(T_world_camera, ranged);
  map.floor.observe(surface_points(disparity, camera, T_world_camera, ranged.max_clearing_m),
                    T_world_camera.translation);
}

FrameView view_frame(const DisparityImage& disparity, const RectifiedCamera& camera,
                     const SE3& T_world_camera, std::int64_t stamp_ns,
                     const OccupancyParams& params, VoxelMap& map) {
  check_caller(disparity, camera, T_world_camera);
  if (params.voxel_size_m != map.voxel_size_m())
    throw Error(fmt::format("voxel size of the map is {} m, of the configuration {} m",
                            map.voxel_size_m(), params.voxel_size_m));
  const OccupancyParams ranged = with_ranges(params, camera);
  check_reach(T_world_camera, ranged);
  const auto [lowest_floor_m, highest_floor_m] =
      map.floor.z_range_m(T_world_camera.translation.head<2>(), ranged.max_clearing_m);
  return {.disparity = disparity,
          .camera = camera,
          .params = ranged,
          .steps = sampling_steps(params, camera),
          .profile = profile_of(params.update),
          .T_world_camera = T_world_camera,
          .T_camera_world = inverse(T_world_camera),
          .measuring = measuring_frame(params.error_model, camera, T_world_camera),
          .stamp_ms = stamp_in_map_ms(stamp_ns, map),
          .min_z_m = lowest_floor_m + params.min_height_m,
          .max_z_m = highest_floor_m + params.max_height_m};
}

std::optional<PointMeasurement> measure_pixel(const FrameView& frame, int u, int v) {
  const float disparity_px = frame.disparity.disparity_px(v, u);
  const float sigma_px = frame.disparity.sigma_px(v, u);
  if (!is_measured(disparity_px, sigma_px)) return std::nullopt;
  const PointMeasurement point = measure_point(frame.measuring, {u, v}, disparity_px, sigma_px);
  if (point.depth_m < frame.params.min_depth_m || point.p_world.z() < frame.min_z_m)
    return std::nullopt;
  return point;
}

double max_sigma_m(const OccupancyParams& params) {
  const double half_voxel_m = 0.5 * params.voxel_size_m;
  return std::min(params.max_sigma_half_voxels * half_voxel_m,
                  std::max(params.max_sigma_m, half_voxel_m));
}

bool marks_surface(const FrameView& frame, const PointMeasurement& point) {
  return point.depth_m <= frame.params.max_depth_m &&
         point.sigma_range_m <= max_sigma_m(frame.params) && point.p_world.z() <= frame.max_z_m;
}

bool is_exact(const FrameView& frame, const PointMeasurement& point) {
  return point.sigma_range_m < 0.5 * frame.params.voxel_size_m;
}

FreeMargin free_margin(const FrameView& frame) {
  const double half_voxel_m = 0.5 * frame.params.voxel_size_m;
  if (frame.profile == nullptr) return {frame.params.free_margin_sigmas, 0.0, half_voxel_m};
  return {kSplineReach, half_voxel_m * frame.profile->min_sigma_half_voxels, half_voxel_m};
}

std::optional<Segment> free_segment(const FrameView& frame, const PointMeasurement& point) {
  return within_heights(frame, point, {0.0, free_end_m(frame, point)});
}

float free_end_m(const FrameView& frame, int u, int v) {
  const std::optional<PointMeasurement> point = measure_pixel(frame, u, v);
  return point ? static_cast<float>(std::max(0.0, free_end_m(frame, *point))) : 0.0F;
}

std::optional<Segment> profile_segment(const FrameView& frame, const PointMeasurement& point) {
  const double begin_m = std::max(0.0, point.range_m - free_margin(frame).of(point.sigma_range_m));
  const double end_m = frame.profile->extent(point, frame.params.voxel_size_m).end_m;
  return within_heights(frame, point, {begin_m, end_m});
}

Chord chord_in(const FrameView& frame, const Eigen::Vector3d& inverse_ray,
               const Eigen::Vector3i& voxel) {
  const double size_m = frame.params.voxel_size_m;
  const Eigen::Array3d low_m =
      voxel.cast<double>().array() * size_m - frame.T_world_camera.translation.array();
  Chord chord{.begin_m = 0.0, .end_m = std::numeric_limits<double>::infinity()};
  for (int axis = 0; axis < 3; ++axis) {
    if (!std::isfinite(inverse_ray[axis])) continue;  // runs along the faces, between them
    const auto [in_m, out_m] =
        std::minmax({low_m[axis] * inverse_ray[axis], (low_m[axis] + size_m) * inverse_ray[axis]});
    chord.begin_m = std::max(chord.begin_m, in_m);
    chord.end_m = std::min(chord.end_m, out_m);
  }
  return chord;
}

ExpectedPoints::ExpectedPoints(const FrameView& frame)
    : voxel_size_m_(frame.params.voxel_size_m),
      min_depth_m_(frame.params.min_depth_m),
      camera_m_(frame.T_world_camera.translation),
      forward_(frame.measuring.R_world_camera.col(2)) {
  const double area = voxel_size_m_ * voxel_size_m_;
  const double step = frame.steps.surface_px;
  at_one_metre_ = frame.params.valid_fraction * area * frame.camera.pinhole.fx_px *
                  frame.camera.pinhole.fy_px / (step * step);
}

bool is_in_frustum(const FrameView& frame, const Eigen::Vector3i& voxel) {
  constexpr double kHalfPixel = 0.5;
  const Eigen::Vector3d center = voxel_center_of(frame.params.voxel_size_m, voxel);
  if (center.z() < frame.min_z_m || center.z() > frame.max_z_m) return false;
  const Eigen::Vector3d p_camera = frame.T_camera_world * center;
  if (p_camera.z() < frame.params.min_depth_m || p_camera.z() > frame.params.max_depth_m)
    return false;
  const Eigen::Vector2d pixel = project(frame.camera.pinhole, p_camera);
  return pixel.x() >= -kHalfPixel && pixel.y() >= -kHalfPixel &&
         pixel.x() < frame.camera.pinhole.width - kHalfPixel &&
         pixel.y() < frame.camera.pinhole.height - kHalfPixel;
}

VoxelBounds frustum_bounds(const FrameView& frame) {
  const PinholeCamera& c = frame.camera.pinhole;
  Eigen::Vector3d low = frame.T_world_camera.translation, high = low;
  for (const double u : {-1.0, double(c.width)})
    for (const double v : {-1.0, double(c.height)}) {
      const Eigen::Vector3d ray((u - c.cx_px) / c.fx_px, (v - c.cy_px) / c.fy_px, 1.0);
      const Eigen::Vector3d corner = frame.T_world_camera * (frame.params.max_depth_m * ray);
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
  low.z() = std::max(low.z(), frame.min_z_m);
  high.z() = std::min(high.z(), frame.max_z_m);
  return {voxel_index_of(frame.params.voxel_size_m, low),
          voxel_index_of(frame.params.voxel_size_m, high)};
}

}  // namespace stereovox
