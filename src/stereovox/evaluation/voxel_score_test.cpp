#include "stereovox/evaluation/voxel_score.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "stereovox/core/error.h"
#include "stereovox/evaluation/nearest_voxel.h"
#include "stereovox/navmap/drawn_map_for_test.h"

namespace stereovox {
namespace {

// A row of voxels of 0.1 m is a slice through a wall: free, three occupied, free.
const Drawing kWall = {"...###..", "...###..", "...###.."};

VoxelScore score(const Drawing& ideal, const Drawing& generated) {
  return score_voxels(drawn_voxels(ideal), drawn_voxels(generated), {});
}

TEST(VoxelScore, OfAPerfectMapWithAnUnseenInsideIsPerfect) {
  const VoxelScore s = score(kWall, {"...#?#..", "...#?#..", "...#?#.."});
  EXPECT_EQ(s.compared, 21);
  EXPECT_EQ(s.surface, 6);
  EXPECT_EQ(s.surface_in_view, 6);
  EXPECT_DOUBLE_EQ(s.f1.value(), 1.0);
  EXPECT_DOUBLE_EQ(s.iou.value(), 1.0);
  EXPECT_DOUBLE_EQ(s.accuracy_m.value(), 0.0);
  EXPECT_DOUBLE_EQ(s.completeness.value(), 1.0);
  EXPECT_DOUBLE_EQ(s.f_score.value(), 1.0);
}

TEST(VoxelScore, CountsInventionsAndMissesWhereBothMapsKnow) {
  const VoxelScore s = score(kWall, {"#..#????", "....????", "...#????"});
  EXPECT_EQ(s.compared, 12);
  EXPECT_EQ(s.true_positives, 2);
  EXPECT_EQ(s.false_positives, 1);
  EXPECT_EQ(s.surface, 3);
  EXPECT_EQ(s.surface_missed, 1);
  EXPECT_DOUBLE_EQ(s.precision.value(), 2.0 / 3);
  EXPECT_DOUBLE_EQ(s.recall.value(), 2.0 / 3);
  EXPECT_DOUBLE_EQ(s.iou.value(), 2.0 / 4);
  EXPECT_DOUBLE_EQ(s.tolerant_precision.value(), 2.0 / 3);
  EXPECT_DOUBLE_EQ(s.tolerant_recall.value(), 1.0);
}

TEST(VoxelScore, AWallInViewThatWasNeverMarkedCostsCompletenessNotRecall) {
  const VoxelScore s = score(kWall, {"...#????", "...?????", "...?????"});
  EXPECT_DOUBLE_EQ(s.recall.value(), 1.0);
  EXPECT_EQ(s.surface_in_view, 3);
  EXPECT_DOUBLE_EQ(s.completeness.value(), 2.0 / 3);
}

TEST(VoxelScore, MeasuresDistancesBothWays) {
  // The wall is seen 0.2 m too near; its three surface voxels are in view beside free ones.
  const VoxelScore s = score(kWall, {".#.?????", ".#.?????", ".#.?????"});
  EXPECT_DOUBLE_EQ(s.accuracy_m.value(), 0.2);
  EXPECT_DOUBLE_EQ(s.chamfer_m.value(), 0.2);
  EXPECT_DOUBLE_EQ(s.completeness.value(), 0.0);
  EXPECT_DOUBLE_EQ(s.f_score.value(), 0.0);
}

TEST(VoxelScore, VoxelsObservedTooSeldomAreNotKnown) {
  VoxelMap seldom = drawn_voxels(kWall);
  set_voxel(seldom, {0, 0, kDrawnLayer}, kOccupiedState, 2);
  EXPECT_EQ(score_voxels(drawn_voxels(kWall), seldom, {}).compared, 23);
  EXPECT_EQ(score_voxels(drawn_voxels(kWall), seldom, {.min_observations = 2}).false_positives, 1);
}

TEST(VoxelScore, OfAnEmptyMapHasNoFigures) {
  const VoxelScore s = score(kWall, {"?"});
  EXPECT_FALSE(s.precision || s.recall || s.accuracy_m || s.completeness);
  EXPECT_TRUE(to_json(s).at("precision").is_null());
}

TEST(VoxelScore, MapsOfOtherVoxelsAreRefused) {
  try {
    score_voxels(VoxelMap(0.1), VoxelMap(0.05), {});
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "voxel maps: voxels of 0.1 m and of 0.05 m cannot be compared");
  }
}

TEST(NearestVoxel, EqualsTheSearchThroughAll) {
  std::mt19937 random(5);
  const auto draw = [&] {
    const auto coordinate = [&] { return static_cast<int>(random() % 41) - 20; };
    const int x = coordinate(), y = coordinate(), z = coordinate();
    return Eigen::Vector3i(x, y, z);
  };
  std::vector<Eigen::Vector3i> voxels(300);
  for (Eigen::Vector3i& voxel : voxels) voxel = draw();
  const NearestVoxel nearest(voxels);
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3i place = draw();
    std::int64_t expected = 1 << 30;
    for (const Eigen::Vector3i& voxel : voxels)
      expected = std::min<std::int64_t>(expected, (voxel - place).squaredNorm());
    EXPECT_EQ(nearest.squared_distance(place), expected);
  }
  EXPECT_THROW(NearestVoxel({}), std::logic_error);
}

}  // namespace
}  // namespace stereovox
