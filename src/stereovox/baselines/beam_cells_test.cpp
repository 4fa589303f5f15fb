#include "stereovox/baselines/beam_cells.h"

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

#include "stereovox/baselines/frame_evidence.h"
#include "stereovox/navmap/drawn_map_for_test.h"

namespace stereovox {
namespace {

constexpr double kPi = std::numbers::pi;
const GridGeometry kGrid{.origin_m = {}, .cell_size_m = 0.5, .width = 6, .height = 4};

Drawing crossed_cells(const Ray2D& ray, double length_m) {
  OccupancyGrid2D grid = unknown_grid(kGrid, "test");
  for_each_beam_cell(kGrid, ray, length_m,
                     [&](const BeamCell& cell) { grid.labels[cell.position] = CellLabel::free; });
  return drawing_of(grid);
}

TEST(BeamCells, ObliqueRayCrossesEveryCellOnItsWay) {
  EXPECT_EQ(crossed_cells({{0.1, 0.1}, std::atan2(0.5, 1.0)}, 10.0), (Drawing{"?????.",  //
                                                                              "???...",  //
                                                                              "?...??",  //
                                                                              "..????"}));
}

TEST(BeamCells, RayEndsInTheCellAtItsLength) {
  EXPECT_EQ(crossed_cells({{2.75, 1.75}, kPi}, 1.1), (Drawing{"???...",  //
                                                              "??????",  //
                                                              "??????",  //
                                                              "??????"}));
}

TEST(BeamCells, RayFromOutsideBeginsAtTheBorder) {
  EXPECT_EQ(crossed_cells({{1.25, -3.0}, 0.5 * kPi}, 4.2), (Drawing{"??????",  //
                                                                    "??.???",  //
                                                                    "??.???",  //
                                                                    "??.???"}));
}

TEST(BeamCells, DistancesAreThoseOfCentresAndBorders) {
  std::vector<double> enter_m, distance_m;
  for_each_beam_cell(kGrid, {{0.35, 0.25}, 0.0}, 1.2, [&](const BeamCell& cell) {
    enter_m.push_back(cell.enter_m);
    distance_m.push_back(cell.distance_m);
  });
  ASSERT_EQ(enter_m.size(), 4U);
  EXPECT_EQ(enter_m[0], 0.0);
  EXPECT_NEAR(distance_m[0], -0.1, 1e-12);
  EXPECT_NEAR(enter_m[3], 1.15, 1e-12);
  EXPECT_NEAR(distance_m[3], 1.4, 1e-12);
}

std::vector<double> fused(const std::vector<double>& evidence) {
  FrameEvidence frame(1);
  for (const double log_odds : evidence) frame.add(0, log_odds);
  std::vector<double> result;
  frame.hand_over([&](std::size_t, double log_odds) { result.push_back(log_odds); });
  return result;
}

TEST(FrameEvidence, OneHitOutweighsAllFreeBeamsOfTheFrame) {
  EXPECT_EQ(fused({-0.4, 0.7, -0.4, 0.9, -0.4}), std::vector{0.9});
}

TEST(FrameEvidence, ManyFreeBeamsCountOnce) {
  EXPECT_EQ(fused({-0.4, -0.5, -0.4}), std::vector{-0.5});
}

TEST(FrameEvidence, NextFrameBeginsEmpty) {
  FrameEvidence frame(2);
  frame.add(1, 0.7);
  frame.hand_over([](std::size_t, double) {});
  frame.add(1, -0.4);
  frame.hand_over([](std::size_t position, double log_odds) {
    EXPECT_EQ(position, 1U);
    EXPECT_EQ(log_odds, -0.4);
  });
}

}  // namespace
}  // namespace stereovox
