// What a planar range finder at the camera would have read: the common input of the older paradigms
// (method.md C.0).
//
// A frame becomes a fan of bearing bins. The reading of a bin is the nearest range that enough
// points of the height band support. A bin without a reading may still say how far it is free,
// because floor or background is seen through it. A missing match says nothing: else a wall without
// texture would become free space.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "stereovox/core/camera.h"
#include "stereovox/core/image.h"
#include "stereovox/core/parameters.h"
#include "stereovox/core/se3.h"

namespace stereovox {

struct Beam {
  double bearing_rad = 0;  // from the scan's heading, counter-clockwise, middle of the bin
  double range_m = 0;      // horizontal; meaningless without has_range
  double sigma_m = 0;      // its standard deviation; meaningless without has_range
  bool has_range = false;
  double free_range_m = 0;  // farthest range that floor or background shows to be free; 0 = none
};

struct PseudoScan {
  std::int64_t stamp_ns = 0;
  Eigen::Vector2d position_m = {0, 0};  // of the camera in the world
  double heading_rad = 0;               // of the optical axis, from the world's x axis
  std::vector<Beam> beams;              // by rising bearing, equally spaced
};

// How far a beam says anything about free space: its reading, or how far it is free without one.
inline double clear_range_m(const Beam& beam) {
  return beam.has_range ? beam.range_m : beam.free_range_m;
}

struct PseudoScanParams {
  double min_height_m = 0.15, max_height_m = 1.5;  // of points that are obstacles
  double floor_tolerance_m = 0.15;
  int speckle_size_px = 100;
  double speckle_range_px = 1.0;
  double bin_width_deg = 0.5;
  int min_points = 5;
  double max_range_m = 5.0;
  double free_margin_m = 0.25;
  double sigma_pointing_px = 0.5;
  double min_sigma_disparity_px = 0.25;
  double min_sigma_range_m = 0.01;

  void describe(ParameterList& list);
};

// Standard deviation of the distance of a triangulated point from the camera, eq. (10) corrected
// with the camera as fixed point. (u, v) is the pixel; the disparity is above 0.
double range_sigma_m(const RectifiedCamera& camera, double u_px, double v_px, double disparity_px,
                     double sigma_pointing_px, double sigma_disparity_px);

// Ranges and bearings lie in the horizontal plane at the camera, however the camera is pitched or
// rolled (its optical axis must not be vertical). `floor_z_m` is the floor's height in the world.
// free_range_m is cut at max_range_m + free_margin_m, and each point counts three of its sigmas
// nearer, because the farthest of many noisy points is too far. Throws UsageError when the height
// band is upside down.
PseudoScan pseudo_scan(const DisparityImage& disparity, const RectifiedCamera& camera,
                       const SE3& T_world_camera, double floor_z_m, std::int64_t stamp_ns,
                       const PseudoScanParams& params);

}  // namespace stereovox
