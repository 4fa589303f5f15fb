#include "stereovox/navmap/hidden_cells.h"

#include <gtest/gtest.h>

#include "stereovox/navmap/drawn_map_for_test.h"

namespace stereovox {
namespace {

Drawing without_hidden(const Drawing& drawing) {
  OccupancyGrid2D map = drawn_grid(drawing);
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

TEST(ForgetHiddenCells, AMapWithoutFreeSpaceShowsNothing) {
  EXPECT_EQ(without_hidden({"##?", "?##"}), (Drawing{"???", "???"}));
}

}  // namespace
}  // namespace stereovox
