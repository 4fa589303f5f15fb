#include "stereovox/navmap/thin_walls.h"

#include <gtest/gtest.h>

#include <numbers>

#include "stereovox/navmap/drawn_map_for_test.h"
#include "stereovox/occupancy/scene_for_test.h"

namespace stereovox {
namespace {

constexpr double kContrast = 0.05;

// Whether these cells are free or occupied, nobody knows: "?" in a drawing.
void doubt(const std::vector<std::size_t>& positions, OccupancyGrid2D& map) {
  for (const std::size_t position : positions) {
    EXPECT_EQ(map.labels[position], CellLabel::free);
    map.labels[position] = CellLabel::unknown;
  }
}

// The states of the occupied cells, row by row as drawn, from the left.
Drawing thinned(const Drawing& drawing, const std::vector<float>& states) {
  OccupancyGrid2D map = drawn_grid(drawing);
  std::size_t next = 0;
  for (int y = map.geometry.height - 1; y >= 0; --y)
    for (int x = 0; x < map.geometry.width; ++x)
      if (map.label_at({x, y}) == CellLabel::occupied)
        map.states[map.position_of({x, y})] = states.at(next++);
  doubt(thin_walls(map, {}, {.wall_contrast = kContrast}), map);
  return drawing_of(map);
}

TEST(ThinWalls, TheLayerWithLessEvidenceBeforeTheWallIsDoubtful) {
  EXPECT_EQ(thinned({"..##?", "..##?"}, {0.6F, 0.9F, 0.6F, 0.9F}), (Drawing{"..?#?", "..?#?"}));
}

TEST(ThinWalls, TheLayerWithMoreEvidenceStays) {
  EXPECT_EQ(thinned({"..##?"}, {0.9F, 0.6F}), (Drawing{"..##?"}));
  EXPECT_EQ(thinned({"..##?"}, {0.88F, 0.9F}), (Drawing{"..##?"}));
}

TEST(ThinWalls, AWallThatIsOneCellThickStays) {
  EXPECT_EQ(thinned({"..#..", "..#.."}, {0.55F, 0.9F}), (Drawing{"..#..", "..#.."}));
}

TEST(ThinWalls, BothSidesOfAThickWallAreLookedAtBeforeAnyCellChanges) {
  EXPECT_EQ(thinned({".###."}, {0.6F, 0.9F, 0.6F}), (Drawing{".?#?."}));
  EXPECT_EQ(thinned({".####."}, {0.6F, 0.7F, 0.8F, 0.9F}), (Drawing{".?###."}));
}

TEST(ThinWalls, CellsAtTheBorderOfTheMapStay) {
  EXPECT_EQ(thinned({"##", ".."}, {0.6F, 0.9F}), (Drawing{"##", ".."}));
}

// --- With the mean places of surfaces: a wall along y, seen by cameras before and behind it. ---

constexpr double kCell_m = 0.25;

// Adds the faces of a wall that a camera there sees at this depth.
void observe_wall(const SE3& T_world_camera, double depth_m, WallFaces& faces) {
  OccupancyParams occupancy;
  occupancy.voxel_size_m = kCell_m;
  VoxelMap map(kCell_m);
  const DisparityImage image = scene::wall_at(depth_m);
  const RectifiedCamera camera = scene::camera();
  for (int frame = 0; frame < 5; ++frame)
    faces.observe(
        view_frame(image, camera, T_world_camera, frame * scene::kSecond_ns, occupancy, map),
        map.floor, {});
}

// Of a wall that a camera at x = 0 sees at `wall_x_m`.
WallFaces faces_of_wall(double wall_x_m) {
  WallFaces faces;
  observe_wall(scene::level_pose(), wall_x_m, faces);
  return faces;
}

// One row of cells, of which the first is number 5 along x; the border between the last two is at
// 2 m. `state`: of the last but one. Where a wall reaches into a cell by up to 2.5 cm, the cell is
// doubtful.
Drawing placed(const std::string& row, float state, double wall_x_m) {
  OccupancyGrid2D map = drawn_grid({row}, kCell_m, {5 * kCell_m, 0});
  map.states[map.position_of({2, 0})] = state;
  doubt(thin_walls(map, faces_of_wall(wall_x_m), {.min_reach = 0.1}), map);
  return drawing_of(map);
}

TEST(ThinWalls, TheMeanOfThePointsTellsTheLayer) {
  EXPECT_EQ(placed("..##", 0.6F, 1.96), (Drawing{"..##"}));
  EXPECT_EQ(placed("..##", 0.6F, 2.02), (Drawing{"...#"}));
  EXPECT_EQ(placed("...#", 0.4F, 1.96), (Drawing{"..##"}));
  EXPECT_EQ(placed("..?#", 0.4F, 1.96), (Drawing{"..##"}));
  EXPECT_EQ(placed("...#", 0.4F, 2.02), (Drawing{"...#"}));
}

TEST(ThinWalls, AnEmptyCellIsNotFilled) {
  EXPECT_EQ(placed("...#", 0.1F, 1.96), (Drawing{"...#"}));
  EXPECT_EQ(placed("...#", 0.1F, 2.005), (Drawing{"...#"}));
}

TEST(ThinWalls, AWallInTheWrongLayerMoves) {
  EXPECT_EQ(placed("..#?", 0.9F, 1.96), (Drawing{"..#?"}));
  EXPECT_EQ(placed("..#?", 0.9F, 1.985), (Drawing{"..?#"}));
  EXPECT_EQ(placed("..#?", 0.9F, 2.02), (Drawing{"...#"}));
  EXPECT_EQ(placed("..#.", 0.9F, 2.02), (Drawing{"..#."}));
}

TEST(ThinWalls, ABoardOnTheBorderThatIsSeenFromBothSidesStays) {
  OccupancyGrid2D map = drawn_grid({"..##.."}, kCell_m, {5 * kCell_m, 0});
  WallFaces faces = faces_of_wall(1.985);
  observe_wall(scene::level_pose(std::numbers::pi, {4, 0, 1}), 1.985, faces);
  EXPECT_TRUE(thin_walls(map, faces, {.min_reach = 0.1}).empty());
  EXPECT_EQ(drawing_of(map), (Drawing{"..##.."}));
}

TEST(ThinWalls, StatesMoveWithTheWall) {
  OccupancyGrid2D map = drawn_grid({"..#?"}, kCell_m, {5 * kCell_m, 0});
  map.states[map.position_of({1, 0})] = 0.1F;
  map.states[map.position_of({2, 0})] = 0.9F;
  thin_walls(map, faces_of_wall(2.02), {.min_reach = 0.1});
  EXPECT_EQ(map.states[map.position_of({2, 0})], 0.1F);
  EXPECT_EQ(map.states[map.position_of({3, 0})], 0.9F);
}

TEST(ThinWalls, WhereAWallStandsAtTheBorderTheCellBeforeItIsNotCalledFree) {
  EXPECT_EQ(placed("..##", 0.9F, 1.985), (Drawing{"..?#"}));
  EXPECT_EQ(placed("...#", 0.4F, 2.005), (Drawing{"..?#"}));
}

}  // namespace
}  // namespace stereovox
