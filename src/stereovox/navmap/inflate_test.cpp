#include "stereovox/navmap/inflate.h"

#include <gtest/gtest.h>

#include <cmath>

#include "stereovox/core/error.h"
#include "stereovox/navmap/drawn_map_for_test.h"

namespace stereovox {
namespace {

const Drawing kPost = {".......",  //
                       ".......",  //
                       ".......",  //
                       "...#..?",  //
                       ".......",  //
                       ".......",  //
                       "......."};

TEST(Inflate, APioneerBlocksExactlyTheEightNeighboursOfA25CentimetreCell) {
  EXPECT_EQ(drawing_of(inflate(drawn_grid(kPost, 0.25), 0.22)), (Drawing{".......",  //
                                                                         ".......",  //
                                                                         "..###..",  //
                                                                         "..###.?",  //
                                                                         "..###..",  //
                                                                         ".......",  //
                                                                         "......."}));
}

TEST(Inflate, MeasuresFromTheCellsCentreToTheObstaclesEdge) {
  EXPECT_EQ(drawing_of(inflate(drawn_grid(kPost, 0.1), 0.25)), (Drawing{"...#...",  //
                                                                        ".#####.",  //
                                                                        ".#####.",  //
                                                                        "#######",  //
                                                                        ".#####.",  //
                                                                        ".#####.",  //
                                                                        "...#..."}));
}

TEST(Inflate, ADoorOfThreeCellsStaysOpenByOne) {
  EXPECT_EQ(drawing_of(inflate(drawn_grid({"##...##"}, 0.25), 0.22)), Drawing{"###.###"});
}

TEST(Inflate, RadiusZeroChangesNothingAndObstaclesAreCutAtTheMapsEdge) {
  EXPECT_EQ(drawing_of(inflate(drawn_grid(kPost), 0.0)), kPost);
  EXPECT_EQ(drawing_of(inflate(drawn_grid({"#..", "..."}), 0.05)), (Drawing{"##.", "#.."}));
}

TEST(Inflate, ARadiusThatCannotBeIsRefused) {
  EXPECT_THROW(inflate(drawn_grid(kPost), -0.1), UsageError);
  EXPECT_THROW(inflate(drawn_grid(kPost), std::nan("")), UsageError);
}

}  // namespace
}  // namespace stereovox
