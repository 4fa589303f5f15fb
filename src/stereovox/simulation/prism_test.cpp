#include "stereovox/simulation/prism.h"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <numbers>

namespace stereovox {
namespace {

constexpr double kQuarterTurn = std::numbers::pi / 2;

// By the divergence theorem; right only for a closed surface with outward normals.
double enclosed_volume_m3(const TriangleMesh& mesh) {
  double volume = 0.0;
  for (const auto& [a, b, c] : mesh.triangles)
    volume += mesh.corners[a].cast<double>().dot(
                  mesh.corners[b].cast<double>().cross(mesh.corners[c].cast<double>())) /
              6;
  return volume;
}

TEST(Prism, MeshOfABoxEnclosesItsVolume) {
  const Prism box = box_prism({{3, -2}, 0.7}, {2, 1, 0.5}, 0.25, 0);
  EXPECT_NEAR(enclosed_volume_m3(mesh_of(box)), 1.0, 1e-5);
}

TEST(Prism, MeshOfARampEnclosesHalfOfItsBox) {
  const Prism ramp = ramp_prism({{3, -2}, -0.4}, {2, 1, 0.5}, 0.0, 0);
  EXPECT_NEAR(enclosed_volume_m3(mesh_of(ramp)), 0.5, 1e-5);
}

TEST(Prism, PostIsNearlyRound) {
  const Prism post = post_prism({1, 1}, 0.5, 2.0, 0.0, 0);
  EXPECT_NEAR(enclosed_volume_m3(mesh_of(post)), std::numbers::pi * 0.25 * 2.0, 0.03);
}

TEST(Prism, TurnedBoxLiesWhereItShould) {
  const Prism box = box_prism({{5, 5}, kQuarterTurn}, {4, 1, 1}, 0.0, 0);
  EXPECT_TRUE(contains(box.base_m, {5, 6.9}));
  EXPECT_FALSE(contains(box.base_m, {6.9, 5}));
}

TEST(Prism, RampRisesTowardsItsHeading) {
  const Prism ramp = ramp_prism({{0, 0}, kQuarterTurn}, {2, 1, 0.5}, 0.1, 0);
  EXPECT_NEAR(ramp.top_at_m({0, -1}), 0.1, 1e-12);
  EXPECT_NEAR(ramp.top_at_m({0, 1}), 0.6, 1e-12);
}

TEST(Prism, BaseOfARampInABandIsItsHighPart) {
  const Prism ramp = ramp_prism({{0, 0}, 0}, {2, 1, 0.5}, 0.0, 0);
  const Polygon2D high = base_between(ramp, 0.25, 2.0);
  EXPECT_NEAR(area_m2(high), 1.0, 1e-9);
  EXPECT_TRUE(contains(high, {0.5, 0}));
  EXPECT_FALSE(contains(high, {-0.5, 0}));
}

TEST(Prism, WhatLiesOutsideABandHasNoBaseInIt) {
  const Prism lamp = box_prism({{0, 0}, 0}, {1, 1, 0.1}, 2.5, 0);
  EXPECT_THAT(base_between(lamp, 0.15, 1.5), testing::IsEmpty());
  const Prism mat = box_prism({{0, 0}, 0}, {1, 1, 0.02}, 0.0, 0);
  EXPECT_THAT(base_between(mat, 0.15, 1.5), testing::IsEmpty());
}

TEST(Polygon2D, ClippingKeepsTheCommonPart) {
  const Polygon2D square = box_prism({{0, 0}, 0}, {2, 2, 1}, 0, 0).base_m;
  EXPECT_NEAR(area_m2(clipped(square, {0.5, -5}, {5, 0.25})), 0.5 * 1.25, 1e-12);
  EXPECT_THAT(clipped(square, {3, 3}, {4, 4}), testing::IsEmpty());
}

TEST(Polygon2D, ExtentsOfATurnedBoxAreItsSides) {
  const Polygon2D base = box_prism({{3, 1}, 0.6}, {2, 0.3, 1}, 0, 0).base_m;
  EXPECT_NEAR(extents_m(base).x(), 0.3, 1e-9);
  EXPECT_NEAR(extents_m(base).y(), 2.0, 1e-9);
}

TEST(Polygon2D, DistanceIsZeroInsideAndToTheNearestEdgeOutside) {
  const Polygon2D square = box_prism({{0, 0}, 0}, {2, 2, 1}, 0, 0).base_m;
  EXPECT_EQ(distance_m(square, {0.5, 0.5}), 0.0);
  EXPECT_NEAR(distance_m(square, {3, 0.5}), 2.0, 1e-12);
  EXPECT_NEAR(distance_m(square, {4, 5}), 5.0, 1e-12);
}

}  // namespace
}  // namespace stereovox
