// Closed-form occupancy along a ray that measured a surface (Loop et al. 2016; method.md E.7): with
// f = (x - R)/s and F~ a cubic spline for the distribution of the range's error, a place x on the
// ray is occupied by F~(f) - F~(f - 3)/2: 0 = free, 0.5 = nothing is known, the largest within the
// surface, whose thickness is taken as 3 s. From 6 s behind R on it is 0.5.
#pragma once

#include <algorithm>
#include <limits>

#include "stereovox/core/parameters.h"
#include "stereovox/occupancy/stereo_error_model.h"

namespace stereovox {

// The error's distribution is 0 before -kSplineReach standard deviations, and 1 after as many.
inline constexpr double kSplineReach = 3.0;
inline constexpr double kSurfaceThickness = 3.0;  // of the surface, in standard deviations
inline constexpr double kProfileNeutral = 0.5;    // the profile where nothing is known

// F~(t): the distribution function of the sum of three uniform errors, with its inflection at 0.
double spline_distribution(double t);

// F~(f) - F~(f - 3)/2 at f, and its mean over [begin, end].
double profile_at(double f);
double profile_mean(double begin, double end);

// A stretch of a ray, in metres from the camera.
struct Chord {
  double begin_m = 0, end_m = 0;
};

struct SurfaceProfile {
  double min_sigma_half_voxels = 0.25;

  void describe(ParameterList& list) {
    list("min_sigma_half_voxels", min_sigma_half_voxels, {0, 10},
         "smallest error of a range that the profile is drawn with; in half voxel edges");
  }

  double sigma_m(const PointMeasurement& point, double voxel_size_m) const {
    return std::max(point.sigma_range_m, 0.5 * voxel_size_m * min_sigma_half_voxels);
  }
  // Where on the ray the profile is neither free nor unknown.
  Chord extent(const PointMeasurement& point, double voxel_size_m) const {
    const double s = sigma_m(point, voxel_size_m);
    return {point.range_m - kSplineReach * s,
            point.range_m + (kSurfaceThickness + kSplineReach) * s};
  }
  // What the point says of a voxel in which its ray runs along `chord`. Of a voxel much larger than
  // s, most is free space before the surface or unknown space behind it; it is as occupied as the
  // part of the chord that is nearest to the surface, as long as the surface is thick.
  double observe(const PointMeasurement& point, const Chord& chord, double voxel_size_m) const;
};

}  // namespace stereovox
