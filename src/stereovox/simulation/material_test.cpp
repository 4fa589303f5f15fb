#include "stereovox/simulation/material.h"

#include <gmock/gmock.h>

#include <cmath>

namespace stereovox {
namespace {

struct Moments {
  double mean = 0.0, deviation = 0.0;
};

template <class Value>
Moments moments(Value value_at) {
  constexpr int kSamples = 20000;
  double sum = 0.0, squares = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    const double value = value_at(Eigen::Vector3d(0.173 * i, 0.0317 * i, 0.41 * (i % 97)));
    sum += value;
    squares += value * value;
  }
  const double mean = sum / kSamples;
  return {mean, std::sqrt(squares / kSamples - mean * mean)};
}

TEST(LatticeNoise, HasMeanZeroAndVarianceOne) {
  const Moments m = moments([](const Eigen::Vector3d& p) { return lattice_noise(p, 5); });
  EXPECT_NEAR(m.mean, 0.0, 0.03);
  EXPECT_NEAR(m.deviation, 1.0, 0.08);
}

TEST(LatticeNoise, IsContinuousAcrossCells) {
  const double below = lattice_noise({2 - 1e-9, 0.3, 0.4}, 1);
  EXPECT_NEAR(lattice_noise({2 + 1e-9, 0.3, 0.4}, 1), below, 1e-6);
}

TEST(LatticeNoise, DependsOnTheSeed) {
  EXPECT_NE(lattice_noise({1.3, 0.3, 0.4}, 1), lattice_noise({1.3, 0.3, 0.4}, 2));
}

TEST(Material, ContrastIsTheRelativeDeviationOfItsBrightness) {
  const Material wall{.name = "wall", .albedo = 0.5, .contrast = 0.1, .scale_m = 0.3};
  const Moments m = moments([&](const Eigen::Vector3d& p) {
    return albedo_at(wall, p, {1, 0, 0}, 1e-4);
  });
  EXPECT_NEAR(m.mean, 0.5, 0.01);
  EXPECT_NEAR(m.deviation, 0.05, 0.008);
}

TEST(Material, DetailFinerThanAPixelAveragesOut) {
  const Material carpet{.name = "carpet", .albedo = 0.5, .contrast = 0.2, .scale_m = 0.1};
  const Moments far = moments([&](const Eigen::Vector3d& p) {
    return albedo_at(carpet, p, {0, 0, 1}, 0.2);
  });
  EXPECT_NEAR(far.deviation, 0.0, 1e-12);
}

TEST(Material, PatternFollowsTheSurfaceOfAWall) {
  const Material tiles{.name = "tiles",
                       .contrast = 0.0,
                       .pattern = Pattern::tiles,
                       .pattern_size_m = 0.5,
                       .pattern_contrast = 0.5};
  const auto at = [&](double y, double z) { return albedo_at(tiles, {3, y, z}, {1, 0, 0}, 1e-3); };
  EXPECT_EQ(at(0.1, 0.1), at(0.4, 0.4));               // one tile
  EXPECT_LT(at(0.5001, 0.25), at(0.25, 0.25) + 1e-9);  // the joint is dark
  EXPECT_NE(at(0.25, 0.25), at(0.75, 0.25));           // another tile
}

TEST(Material, CommonOnesAreValidAndHaveDifferentNames) {
  std::vector<std::string> names;
  for (Material material : common_materials()) {
    EXPECT_THAT(names, testing::Not(testing::Contains(material.name)));
    names.push_back(material.name);
    const ParameterList list = parameters_of(material);
    for (const Parameter& parameter : list.parameters())
      EXPECT_NO_THROW(parameter.set(parameter.get())) << material.name << " " << parameter.path;
  }
}

}  // namespace
}  // namespace stereovox
