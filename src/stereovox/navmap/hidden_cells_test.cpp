#include "stereovox/navmap/hidden_cells.h"

#include <gtest/gtest.h>

#include "stereovox/navmap/drawn_map_for_test.h"

namespace stereovox {
namespace {

Drawing without_hidden(const Drawing& drawing, double cell_size_m = 0.25) {
  OccupancyGrid2D map = drawn_grid(drawing);
  map.geometry.cell_size_m = cell_size_m;
  forget_hidden_cells(map);
  return drawing_of(map);
}

TEST(ForgetHiddenCells, WhatLiesBehindAWallIsUnknown) {
  EXPECT_EQ(without_hidden({"..#..##", "..#..##", "..#.###"}),
            (Drawing{"..#????", "..#????", "..#????"}));
}

TEST(ForgetHiddenCells, TheFirstLayerOfObstaclesStaysAlsoAtCorners) {
  EXPECT_EQ(without_hidden({"#####", "#...#", "#...#", "####."}),
            (Drawing{"#####", "#...#", "#...#", "####?"}));
}

TEST(ForgetHiddenCells, SolidThingsKeepTheirOutline) {
  EXPECT_EQ(without_hidden({".......", ".#####.", ".#####.", ".#####.", "......."}),
            (Drawing{".......", ".#####.", ".#???#.", ".#####.", "......."}));
}

TEST(ForgetHiddenCells, SmallCellsMayLieBehindABandOfUncertainOnes) {
  EXPECT_EQ(without_hidden({"..??#?#", "..??###"}, 0.1), (Drawing{"..??#??", "..??#??"}));
  EXPECT_EQ(without_hidden({"..??#?#", "..??###"}, 0.05), (Drawing{"..??#?#", "..??###"}));
}

TEST(ForgetHiddenCells, AMapWithoutFreeSpaceShowsNothing) {
  EXPECT_EQ(without_hidden({"##?", "?##"}), (Drawing{"???", "???"}));
}

}  // namespace
}  // namespace stereovox
