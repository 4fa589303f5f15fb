#include "stereovox/occupancy/voxel_ray.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "stereovox/occupancy/block_index.h"

namespace stereovox {
namespace {

constexpr double kSize_m = 0.1;

std::vector<Eigen::Vector3i> walk(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  std::vector<Eigen::Vector3i> voxels;
  for_each_voxel_on_segment(from, to, kSize_m,
                            [&](const Eigen::Vector3i& voxel) { voxels.push_back(voxel); });
  return voxels;
}

// Length of the segment (in shares of it) inside the cube of a voxel, by clipping at its slabs.
double share_inside(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                    const Eigen::Vector3i& voxel) {
  double in = 0.0, out = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double way = to[axis] - from[axis];
    const double a = (voxel[axis] * kSize_m - from[axis]) / way;
    const double b = ((voxel[axis] + 1) * kSize_m - from[axis]) / way;
    in = std::max(in, std::min(a, b));
    out = std::min(out, std::max(a, b));
  }
  return out - in;
}

TEST(VoxelRay, VisitsExactlyTheVoxelsThatAnExactSlabTestFinds) {
  constexpr double kGrazing = 1e-9;  // shares below this are corners, where rounding may differ
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coordinate(-0.8, 0.8);
  for (int ray = 0; ray < 200; ++ray) {
    const auto point = [&] {
      return Eigen::Vector3d(coordinate(random), coordinate(random), coordinate(random));
    };
    const Eigen::Vector3d from = point(), to = point();
    std::set<Eigen::Vector3i, LatticeOrder> visited;
    for (const auto& voxel : walk(from, to)) {
      EXPECT_TRUE(visited.insert(voxel).second) << "visited twice";
      EXPECT_GT(share_inside(from, to, voxel), -kGrazing);
    }
    for (int x = -9; x <= 9; ++x)
      for (int y = -9; y <= 9; ++y)
        for (int z = -9; z <= 9; ++z)
          EXPECT_TRUE(share_inside(from, to, {x, y, z}) <= kGrazing || visited.contains({x, y, z}))
              << x << " " << y << " " << z;
  }
}

TEST(VoxelRay, GoesFromFaceToFaceAndEndsInTheLastVoxel) {
  const Eigen::Vector3d from(-0.73, 0.21, 0.05), to(0.64, -0.38, 0.91);
  const auto voxels = walk(from, to);
  EXPECT_EQ(voxels.front(), voxel_index_of(kSize_m, from));
  EXPECT_EQ(voxels.back(), voxel_index_of(kSize_m, to));
  for (std::size_t i = 1; i < voxels.size(); ++i)
    EXPECT_EQ((voxels[i] - voxels[i - 1]).cwiseAbs().sum(), 1);
}

TEST(VoxelRay, FollowsAnAxisAlongAFaceInBothDirections) {
  EXPECT_EQ(walk({0.05, 0.0, 0.0}, {0.35, 0.0, 0.0}).size(), 4U);
  EXPECT_EQ(walk({0.35, 0.0, 0.0}, {0.05, 0.0, 0.0}).size(), 4U);
}

TEST(VoxelRay, InsideOneVoxelVisitsIt) {
  EXPECT_EQ(walk({0.01, 0.02, 0.03}, {0.01, 0.02, 0.03}).size(), 1U);
}

TEST(VoxelRay, ThroughCornersReachesItsEnd) {
  const auto voxels = walk({0.0, 0.0, 0.0}, {0.5, 0.5, 0.5});
  EXPECT_EQ(voxels.back(), Eigen::Vector3i(5, 5, 5));
  EXPECT_EQ(voxels.size(), 16U);
}

}  // namespace
}  // namespace stereovox
