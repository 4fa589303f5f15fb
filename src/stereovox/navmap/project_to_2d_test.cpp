#include "stereovox/navmap/project_to_2d.h"

#include <gtest/gtest.h>

#include "stereovox/core/error.h"
#include "stereovox/navmap/drawn_map_for_test.h"

namespace stereovox {
namespace {

Drawing projected(const VoxelMap& map, const NavmapParams& params = {}) {
  return drawing_of(project_to_2d(map, {}, params));
}

TEST(ProjectTo2D, KeepsTheLabelsOfOneLayer) {
  const Drawing drawing = {"####.....", "#..#..??.", "#..?...#.", "####....."};
  EXPECT_EQ(projected(drawn_voxels(drawing)), drawing);
}

TEST(ProjectTo2D, TheGridIsTheBoundingBoxOfWhatIsKnownAndStartsOnTheLattice) {
  VoxelMap map(0.25);
  set_voxel(map, {-3, 2, 1}, kFreeState);
  set_voxel(map, {10, 4, 1}, kOccupiedState);
  const OccupancyGrid2D grid = project_to_2d(map, {}, {});
  EXPECT_EQ(grid.geometry, (GridGeometry{{-0.75, 0.5}, 0.25, 14, 3}));
  EXPECT_EQ(grid.label_at({0, 0}), CellLabel::free);
  EXPECT_EQ(grid.label_at({13, 2}), CellLabel::occupied);
}

TEST(ProjectTo2D, OfAnEmptyMapIsOneUnknownCell) {
  const OccupancyGrid2D grid = project_to_2d(VoxelMap(0.05), {}, {});
  EXPECT_EQ(drawing_of(grid), Drawing{"?"});
  EXPECT_EQ(grid.geometry.cell_size_m, 0.05);
}

TEST(ProjectTo2D, TheLargestStateOfAColumnDecides) {
  VoxelMap map = drawn_voxels({".."});
  set_voxel(map, {1, 0, kDrawnLayer + 7}, 0.75F);
  const OccupancyGrid2D grid = project_to_2d(map, {}, {});
  EXPECT_EQ(drawing_of(grid), Drawing{".#"});
  EXPECT_EQ(grid.states, (std::vector{kFreeState, 0.75F}));
}

// Voxel centres at 0.05, 0.15 .. above a floor at 1 m; the band 0.15 .. 1.5 m includes its ends.
TEST(ProjectTo2D, FloorAndCeilingAreOutsideTheBand) {
  VoxelMap map(0.1, 1.0);
  int x = 0;
  for (const int z : {10, 11, 24, 25}) set_voxel(map, {x++, 0, z}, kOccupiedState);
  for (x = 0; x < 4; ++x) set_voxel(map, {x, 0, 15}, kFreeState);
  EXPECT_EQ(projected(map), Drawing{".##."});
  EXPECT_EQ(projected(map, {.column = ColumnRule::whole}), Drawing{"####"});
}

TEST(ProjectTo2D, VoxelsThatWereSeldomObservedLeaveTheCellUnknown) {
  VoxelMap map(0.1);
  for (int x = 0; x < 4; ++x)
    set_voxel(map, {x, 0, kDrawnLayer}, kOccupiedState, static_cast<std::uint16_t>(x + 1));
  EXPECT_EQ(projected(map), Drawing{"??##"});
  EXPECT_EQ(projected(map, {.min_observations = 1}), Drawing{"####"});
}

TEST(ProjectTo2D, AStateAtTheThresholdIsNeitherFreeNorOccupied) {
  VoxelMap map(0.1);
  int x = 0;
  for (const float state : {0.499F, 0.5F, 0.501F}) set_voxel(map, {x++, 0, kDrawnLayer}, state);
  EXPECT_EQ(projected(map), Drawing{".?#"});
}

TEST(ProjectTo2D, ALowerFreeThresholdLeavesFaintObstaclesUnknown) {
  VoxelMap map = drawn_voxels({".."});
  set_voxel(map, {1, 0, kDrawnLayer + 1}, 0.3F);
  EXPECT_EQ(projected(map), Drawing{".."});
  EXPECT_EQ(projected(map, {.free_threshold = 0.25}), Drawing{".?"});
}

TEST(ProjectTo2D, AsPrintedOnlyLinesOfSightMakeACellFree) {
  VoxelMap map = drawn_voxels({"..#"});
  NavmapParams params;
  apply_settings({{"preset", "literal"}}, params);
  EXPECT_EQ(projected(map, params), Drawing{"??#"});
  SightLines sight_lines;
  sight_lines.observe(map, {0.15, 0.05}, {}, params);
  EXPECT_EQ(drawing_of(project_to_2d(map, sight_lines, params)), Drawing{"?.#"});
}

TEST(ProjectTo2D, CellsOnLinesOfSightBelongToTheGrid) {
  VoxelMap map(0.1);
  set_voxel(map, {5, 0, kDrawnLayer}, kOccupiedState);
  SightLines sight_lines;
  sight_lines.observe(map, {0.15, 0.05}, std::vector<Eigen::Vector3i>{{5, 0, kDrawnLayer}}, {});
  EXPECT_EQ(drawing_of(project_to_2d(map, sight_lines, {})), Drawing{"....#"});
}

TEST(ProjectTo2D, AnObstacleThatAppearsOnALineOfSightIsOccupied) {
  VoxelMap map = drawn_voxels({"????#"});
  SightLines sight_lines;
  sight_lines.observe(map, {0.05, 0.05}, std::vector<Eigen::Vector3i>{{4, 0, kDrawnLayer}}, {});
  set_voxel(map, {2, 0, kDrawnLayer}, kOccupiedState);
  EXPECT_EQ(drawing_of(project_to_2d(map, sight_lines, {})), Drawing{"..#.#"});
}

TEST(ProjectTo2D, AnOccupiedCellWhoseStateDropsIsFreeAgain) {
  VoxelMap map = drawn_voxels({"#"});
  set_voxel(map, {0, 0, kDrawnLayer}, 0.3F);
  EXPECT_EQ(projected(map), Drawing{"."});
}

TEST(ProjectTo2D, AMapTooWideForAGridIsAnError) {
  VoxelMap map(0.05);
  set_voxel(map, {0, 0, 5}, kFreeState);
  set_voxel(map, {9'999, 6'400, 5}, kFreeState);
  try {
    projected(map);
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "map: a map of 10000 x 6401 cells of 0.05 m is not between 1 and 64000000 cells");
  }
}

TEST(ProjectTo2D, ABandThatIsUpsideDownIsAUsageError) {
  EXPECT_THROW(projected(VoxelMap(0.1), {.min_height_m = 2.0}), UsageError);
}

TEST(NavmapParams, AFieldSetBesideAPresetKeepsItsValue) {
  NavmapParams params;
  apply_settings({{"label_rule", "visible"}, {"preset", "literal"}}, params);
  EXPECT_EQ(params.label_rule, LabelRule::visible);
  EXPECT_EQ(params.column, ColumnRule::whole);
  EXPECT_EQ(params.min_observations, 1);
  apply_settings({{"preset", "corrected"}}, params);
  EXPECT_EQ(params.column, ColumnRule::band);
  EXPECT_EQ(params.min_observations, 3);
  apply_settings({{"preset", "tuned"}}, params);
  EXPECT_EQ(params.min_observations, 2);
}

}  // namespace
}  // namespace stereovox
