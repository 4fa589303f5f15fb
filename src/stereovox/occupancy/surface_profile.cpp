#include "stereovox/occupancy/surface_profile.h"

#include <cmath>

namespace stereovox {
namespace {

// Integral of F~ from -infinity to t <= 0.
double integral_below(double t) {
  constexpr double kUpToMinusOne = 1.0 / 12.0;
  if (t <= -kSplineReach) return 0.0;
  if (t <= -1.0) return std::pow(t + 3.0, 4) / 192.0;
  const double t2 = t * t;
  return kUpToMinusOne + 0.5 * (t + 1.0) + (4.5 * t2 - 0.25 * t2 * t2 - 4.25) / 24.0;
}

// Integral of F~ from -infinity to t, with F~(t) = 1 - F~(-t).
double integral(double t) { return t <= 0.0 ? integral_below(t) : t + integral_below(-t); }

}  // namespace

double spline_distribution(double t) {
  if (t > 0.0) return 1.0 - spline_distribution(-t);
  if (t <= -kSplineReach) return 0.0;
  if (t <= -1.0) return std::pow(t + 3.0, 3) / 48.0;
  return 0.5 + t * (t + 3.0) * (3.0 - t) / 24.0;
}

double profile_at(double f) {
  return spline_distribution(f) - 0.5 * spline_distribution(f - kSurfaceThickness);
}

double profile_mean(double begin, double end) {
  constexpr double kMinLength = 1e-6;  // shorter, the difference of integrals is all rounding
  if (end - begin < kMinLength) return profile_at(begin);
  const double front = integral(end) - integral(begin);
  const double back = integral(end - kSurfaceThickness) - integral(begin - kSurfaceThickness);
  return std::clamp((front - 0.5 * back) / (end - begin), 0.0, 1.0);
}

double SurfaceProfile::observe(const PointMeasurement& point, const Chord& chord,
                               double voxel_size_m) const {
  // A point without error is a thin surface, not 0/0.
  constexpr double kMinSigma_m = 1e-6;
  const double s = std::max(sigma_m(point, voxel_size_m), kMinSigma_m);
  const double first = (chord.begin_m - point.range_m) / s;
  const double last = (chord.end_m - point.range_m) / s;
  const double begin = std::clamp(0.0, first, std::max(first, last - kSurfaceThickness));
  return profile_mean(begin, std::min(last, begin + kSurfaceThickness));
}

}  // namespace stereovox
