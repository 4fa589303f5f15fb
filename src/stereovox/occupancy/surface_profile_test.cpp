#include "stereovox/occupancy/surface_profile.h"

#include <gtest/gtest.h>

namespace stereovox {
namespace {

// Mean of the profile by the midpoint rule.
double numeric_mean(double begin, double end) {
  constexpr int kSteps = 20000;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) sum += profile_at(begin + (end - begin) * (i + 0.5) / kSteps);
  return sum / kSteps;
}

TEST(SurfaceProfile, IsFreeFarBeforeTheSurfaceAndUnknownFarBehindIt) {
  EXPECT_EQ(profile_at(-3.0), 0.0);
  EXPECT_EQ(profile_at(6.0), 0.5);
  EXPECT_EQ(profile_at(1e6), 0.5);
}

TEST(SurfaceProfile, IsLargestWithinTheSurface) {
  EXPECT_DOUBLE_EQ(profile_at(0.0), 0.5);
  EXPECT_DOUBLE_EQ(profile_at(3.0), 0.75);
  EXPECT_GT(profile_at(1.8), 0.89);
  EXPECT_GT(profile_at(1.8), profile_at(1.0));
  EXPECT_GT(profile_at(1.8), profile_at(2.5));
}

TEST(SurfaceProfile, TheSplineIsADistributionWithoutSteps) {
  for (const double knot : {-3.0, -1.0, 1.0, 3.0})
    EXPECT_NEAR(spline_distribution(knot - 1e-9), spline_distribution(knot + 1e-9), 1e-8) << knot;
  for (double t = -4.0; t < 4.0; t += 0.01)
    EXPECT_LE(spline_distribution(t), spline_distribution(t + 0.01)) << t;
}

TEST(SurfaceProfile, TheClosedMeanIsTheMean) {
  for (const double begin : {-5.0, -2.5, -0.7, 0.0, 0.4, 2.0, 4.0, 5.5})
    for (const double length : {0.01, 0.5, 1.7, 3.0, 9.0})
      EXPECT_NEAR(profile_mean(begin, begin + length), numeric_mean(begin, begin + length), 1e-7)
          << begin << " " << length;
  EXPECT_EQ(profile_mean(0.5, 0.5), profile_at(0.5));
}

// What a point says of the voxels along its ray, nearest first: '.' free, '-' nothing, '#'
// occupied.
std::string row(double range_m, double sigma_m, double voxel_size_m) {
  PointMeasurement point;
  point.range_m = range_m;
  point.sigma_range_m = sigma_m;
  const SurfaceProfile profile{.min_sigma_half_voxels = 0.0};
  std::string row;
  for (int i = 0; i < 10; ++i) {
    const Chord chord{.begin_m = i * voxel_size_m, .end_m = (i + 1) * voxel_size_m};
    const double value = profile.observe(point, chord, voxel_size_m);
    row += value < 0.48 ? '.' : value > 0.52 ? '#' : '-';
  }
  return row;
}

TEST(SurfaceProfile, AVoxelMuchLargerThanTheErrorIsOccupiedWhereverItHoldsTheSurface) {
  EXPECT_EQ(row(1.04, 0.002, 0.25), "....#-----");
  EXPECT_EQ(row(1.12, 0.002, 0.25), "....#-----");
  EXPECT_EQ(row(1.22, 0.002, 0.25), "....#-----");
  EXPECT_EQ(row(1.12, 0.0, 0.25), "....#-----");
}

TEST(SurfaceProfile, AnErrorMuchLargerThanTheVoxelSpreadsAlongTheRayBehindTheSurface) {
  EXPECT_EQ(row(0.25, 0.05, 0.05), ".....#####");
}

TEST(SurfaceProfile, ItsErrorHasAFloor) {
  PointMeasurement point;
  point.sigma_range_m = 0.001;
  EXPECT_DOUBLE_EQ(SurfaceProfile{.min_sigma_half_voxels = 0.5}.sigma_m(point, 0.2), 0.05);
  point.sigma_range_m = 0.3;
  EXPECT_DOUBLE_EQ(SurfaceProfile{.min_sigma_half_voxels = 0.5}.sigma_m(point, 0.2), 0.3);
}

}  // namespace
}  // namespace stereovox
