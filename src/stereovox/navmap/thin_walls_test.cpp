#include "stereovox/navmap/thin_walls.h"

#include <gtest/gtest.h>

#include "stereovox/navmap/drawn_map_for_test.h"

namespace stereovox {
namespace {

constexpr double kContrast = 0.05;

// The states of the occupied cells, row by row as drawn, from the left.
Drawing thinned(const Drawing& drawing, const std::vector<float>& states) {
  OccupancyGrid2D map = drawn_grid(drawing);
  std::size_t next = 0;
  for (int y = map.geometry.height - 1; y >= 0; --y)
    for (int x = 0; x < map.geometry.width; ++x)
      if (map.label_at({x, y}) == CellLabel::occupied)
        map.states[map.position_of({x, y})] = states.at(next++);
  thin_walls(map, kContrast);
  return drawing_of(map);
}

TEST(ThinWalls, TheLayerWithLessEvidenceBeforeTheWallIsFree) {
  EXPECT_EQ(thinned({"..##?", "..##?"}, {0.6F, 0.9F, 0.6F, 0.9F}), (Drawing{"...#?", "...#?"}));
}

TEST(ThinWalls, TheLayerWithMoreEvidenceStays) {
  EXPECT_EQ(thinned({"..##?"}, {0.9F, 0.6F}), (Drawing{"..##?"}));
  EXPECT_EQ(thinned({"..##?"}, {0.88F, 0.9F}), (Drawing{"..##?"}));
}

TEST(ThinWalls, AWallThatIsOneCellThickStays) {
  EXPECT_EQ(thinned({"..#..", "..#.."}, {0.55F, 0.9F}), (Drawing{"..#..", "..#.."}));
}

TEST(ThinWalls, BothSidesOfAThickWallAreLookedAtBeforeAnyCellChanges) {
  EXPECT_EQ(thinned({".###."}, {0.6F, 0.9F, 0.6F}), (Drawing{"..#.."}));
  EXPECT_EQ(thinned({".####."}, {0.6F, 0.7F, 0.8F, 0.9F}), (Drawing{"..###."}));
}

TEST(ThinWalls, CellsAtTheBorderOfTheMapStay) {
  EXPECT_EQ(thinned({"##", ".."}, {0.6F, 0.9F}), (Drawing{"##", ".."}));
}

}  // namespace
}  // namespace stereovox
