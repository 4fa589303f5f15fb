#include "stereovox/occupancy/homogeneity.h"

#include <gtest/gtest.h>

#include "stereovox/occupancy/vectors_for_test.h"

namespace stereovox {
namespace {

TEST(Homogeneity, GivesTheVectors) {
  for (const auto& row : vectors::section("homogeneity")) {
    const std::vector<float> neighbours = row.at("neighbours");
    EXPECT_NEAR(heterogeneity({}, row.at("O"), neighbours), row.at("H").get<double>(), 1e-12)
        << row.dump();
  }
}

TEST(Homogeneity, UnobservedNeighboursAreLeftOutOrCountAsZero) {
  const std::vector<float> wall = {1, 1, 1, 1, 0, kUnobserved};
  const auto H = [&](UnobservedNeighbours u) {
    return heterogeneity({.unobserved = u}, 1.0F, wall);
  };
  EXPECT_DOUBLE_EQ(H(UnobservedNeighbours::excluded), 1.0 / 5);
  EXPECT_DOUBLE_EQ(H(UnobservedNeighbours::count_as_zero), 2.0 / 6);
}

TEST(Homogeneity, WithoutObservedNeighboursNothingDisagrees) {
  EXPECT_EQ(heterogeneity({}, 1.0F, std::vector<float>(6, kUnobserved)), 0.0);
}

TEST(Homogeneity, ItsFloorLetsIsolatedVoxelsChange) {
  EXPECT_DOUBLE_EQ(homogeneity({.min_homogeneity = 0.1}, 1.0), 0.1);
  EXPECT_DOUBLE_EQ(homogeneity({.min_homogeneity = 0.0}, 1.0), 0.0);
  EXPECT_DOUBLE_EQ(homogeneity({}, 0.2), 0.8);
}

TEST(Homogeneity, APlaneHasFourOfSixAndEightOfTwentySixNeighboursInIt) {
  const auto in_plane = [](Neighbourhood n) {
    return std::ranges::count_if(neighbour_steps(n), [](const auto& s) { return s.z() == 0; });
  };
  EXPECT_EQ(neighbour_steps(Neighbourhood::faces).size(), 6U);
  EXPECT_EQ(neighbour_steps(Neighbourhood::cube).size(), 26U);
  EXPECT_EQ(in_plane(Neighbourhood::faces), 4);
  EXPECT_EQ(in_plane(Neighbourhood::cube), 8);
}

}  // namespace
}  // namespace stereovox
