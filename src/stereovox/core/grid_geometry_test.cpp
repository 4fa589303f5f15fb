#include "stereovox/core/grid_geometry.h"

#include <gtest/gtest.h>

#include <cmath>

namespace stereovox {
namespace {

TEST(GridGeometry, CellsAreHalfOpen) {
  const GridGeometry grid{{-1.0, 0.0}, 0.25, 8, 4};
  EXPECT_EQ(index_of(grid, {-1.0, 0.0}), Eigen::Vector2i(0, 0));
  EXPECT_EQ(index_of(grid, {-0.75, 0.2499}), Eigen::Vector2i(1, 0));
  EXPECT_EQ(index_of(grid, {-1.0001, 1.0}), Eigen::Vector2i(-1, 4));
  EXPECT_FALSE(grid.contains({-1, 0}));
  EXPECT_FALSE(grid.contains({0, 4}));
  EXPECT_TRUE(grid.contains({7, 3}));
}

TEST(GridGeometry, CenterLiesInItsOwnCell) {
  const GridGeometry grid{{-1.0, 0.5}, 0.25, 8, 4};
  EXPECT_EQ(center_of(grid, {0, 0}), Eigen::Vector2d(-0.875, 0.625));
  EXPECT_EQ(voxel_index_of(0.05, voxel_center_of(0.05, {-3, 0, 7})), Eigen::Vector3i(-3, 0, 7));
}

TEST(GridGeometry, FloorsLikeTheStandardLibrary) {
  for (const double value : {0.0, -0.0, 0.5, -0.5, 1.0, -1.0, -1.0000001, 2147483646.5,
                             -2147483648.0, -2147483647.5, 1e-300, -1e-300, 123456.999999})
    EXPECT_EQ(floor_to_int(value), static_cast<int>(std::floor(value))) << value;
}

}  // namespace
}  // namespace stereovox
