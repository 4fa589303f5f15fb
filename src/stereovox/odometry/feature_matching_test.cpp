#include "stereovox/odometry/feature_matching.h"

#include <gtest/gtest.h>

namespace stereovox {
namespace {

// A descriptor that points into direction `axis`, and a little into the next one.
PatchDescriptor direction(std::size_t axis, double sideways) {
  PatchDescriptor descriptor{};
  const double length = std::sqrt(1.0 + sideways * sideways);
  descriptor[axis] = static_cast<std::int16_t>(kDescriptorScale / length);
  descriptor[axis + 1] = static_cast<std::int16_t>(kDescriptorScale * sideways / length);
  return descriptor;
}

void add(FeatureSet& set, const Eigen::Vector2d& pixel, const PatchDescriptor& descriptor) {
  set.features.push_back({pixel, 10.0, 0.3});
  set.descriptors.push_back(descriptor);
}

std::vector<Eigen::Vector2d> pixels_of(const FeatureSet& set) {
  std::vector<Eigen::Vector2d> pixels;
  for (const Feature& feature : set.features) pixels.push_back(feature.pixel);
  return pixels;
}

TEST(FeatureMatching, TakesPairsThatAreBestForBoth) {
  FeatureSet reference, current;
  add(reference, {10, 10}, direction(0, 0.0));
  add(reference, {12, 10}, direction(0, 0.3));
  add(current, {14, 10}, direction(0, 0.0));
  const auto matches = match_features(reference, pixels_of(reference), current, 20.0, 0.7);
  ASSERT_EQ(matches.size(), 1U);
  EXPECT_EQ(matches[0].reference, 0);
  EXPECT_NEAR(matches[0].score, 1.0, 1e-3);
}

TEST(FeatureMatching, LooksOnlyNearTheExpectedPlaceAndAtGoodScores) {
  FeatureSet reference, current;
  add(reference, {10, 10}, direction(0, 0.0));
  add(current, {60, 10}, direction(0, 0.0));
  add(current, {11, 10}, direction(0, 2.0));
  EXPECT_TRUE(match_features(reference, pixels_of(reference), current, 20.0, 0.7).empty());
  const std::vector<Eigen::Vector2d> predicted = {{55, 12}};
  const auto matches = match_features(reference, predicted, current, 20.0, 0.7);
  ASSERT_EQ(matches.size(), 1U);
  EXPECT_EQ(matches[0].current, 0);
}

}  // namespace
}  // namespace stereovox
