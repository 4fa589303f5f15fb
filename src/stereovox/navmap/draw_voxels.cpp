#include "stereovox/navmap/draw_voxels.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "stereovox/core/angles.h"
#include "stereovox/core/grid_geometry.h"

namespace stereovox {
namespace {

constexpr double kTopHeight_m = 2.0;
constexpr int kMargin_px = 10;
// Voxels look like cubes when their neighbours differ a little in brightness.
constexpr double kCheckerContrast = 0.06;

// A voxel in the picture's axes: right and down in metres, and how far from the viewer.
struct Splat {
  double right_m, down_m, distance_m;
  cv::Vec3b colour;
};

// Rows: right, down, away from the viewer, in the world.
Eigen::Matrix3d viewing_axes(const VoxelView& view) {
  const double azimuth_rad = view.azimuth_deg * kDegree_rad;
  const double elevation_rad = view.elevation_deg * kDegree_rad;
  const Eigen::Vector3d away(-std::cos(azimuth_rad) * std::cos(elevation_rad),
                             -std::sin(azimuth_rad) * std::cos(elevation_rad),
                             -std::sin(elevation_rad));
  const Eigen::Vector3d right(-std::sin(azimuth_rad), std::cos(azimuth_rad), 0.0);
  Eigen::Matrix3d axes;
  axes << right.transpose(), away.cross(right).transpose(), away.transpose();
  return axes;
}

cv::Mat3b height_colours() {
  cv::Mat1b levels(1, 256);
  for (int i = 0; i < 256; ++i) levels(i) = static_cast<uchar>(i);
  cv::Mat3b colours;
  cv::applyColorMap(levels, colours, cv::COLORMAP_TURBO);
  return colours;
}

cv::Vec3b colour_of(const Eigen::Vector3i& voxel, double height_m, const cv::Mat3b& colours) {
  const double level = std::clamp(height_m / kTopHeight_m, 0.0, 1.0) * 255.0;
  const bool is_odd = ((voxel.x() ^ voxel.y() ^ voxel.z()) & 1) != 0;
  const double brightness = is_odd ? 1.0 - kCheckerContrast : 1.0;
  return cv::Vec3d(colours(static_cast<int>(level))) * brightness;
}

std::vector<Splat> splats_of(const VoxelMap& map, const VoxelView& view) {
  const Eigen::Matrix3d axes = viewing_axes(view);
  const cv::Mat3b colours = height_colours();
  std::vector<Splat> splats;
  map.for_each_block([&](const VoxelBlock& block) {
    for (int i = 0; i < kVoxelsPerBlock; ++i) {
      const Voxel voxel = block.voxels[static_cast<std::size_t>(i)];
      if (voxel.observations < view.min_observations || voxel.state <= view.threshold) continue;
      const Eigen::Vector3i index = voxel_at(block.index, i);
      const Eigen::Vector3d center = voxel_center_of(map.voxel_size_m(), index);
      const Eigen::Vector3d seen = axes * center;
      splats.push_back(
          {seen.x(), seen.y(), seen.z(), colour_of(index, center.z() - map.floor_z_m(), colours)});
    }
  });
  return splats;
}

struct Extent {
  double low = std::numeric_limits<double>::max();
  double high = std::numeric_limits<double>::lowest();
  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  double length() const { return high - low; }
};

}  // namespace

cv::Mat3b draw_voxels(const VoxelMap& map, const VoxelView& view) {
  std::vector<Splat> splats = splats_of(map, view);
  if (splats.empty()) return cv::Mat3b(2 * kMargin_px, 2 * kMargin_px, cv::Vec3b(255, 255, 255));
  Extent right, down;
  for (const Splat& splat : splats) {
    right.add(splat.right_m);
    down.add(splat.down_m);
  }
  const double longest_m = std::max({right.length(), down.length(), map.voxel_size_m()});
  const double px_per_m = (view.longest_side_px - 2 * kMargin_px) / longest_m;
  const auto px = [&](double value_m, double from_m) {
    return kMargin_px + static_cast<int>(std::lround((value_m - from_m) * px_per_m));
  };
  cv::Mat3b picture(px(down.high, down.low) + kMargin_px, px(right.high, right.low) + kMargin_px,
                    cv::Vec3b(255, 255, 255));
  const int side_px = std::max(1, static_cast<int>(std::ceil(map.voxel_size_m() * px_per_m)));
  // The painter's way: what is near covers what is far.
  std::ranges::stable_sort(splats, std::ranges::greater{}, &Splat::distance_m);
  const cv::Rect whole({}, picture.size());
  for (const Splat& splat : splats)
    picture(cv::Rect(px(splat.right_m, right.low) - side_px / 2,
                     px(splat.down_m, down.low) - side_px / 2, side_px, side_px) &
            whole) = splat.colour;
  return picture;
}

}  // namespace stereovox
