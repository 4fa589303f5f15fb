#include "stereovox/evaluation/ideal_map.h"

#include <gtest/gtest.h>

#include "stereovox/core/error.h"
#include "stereovox/evaluation/visible_cells.h"
#include "stereovox/navmap/drawn_map_for_test.h"

namespace stereovox {
namespace {

// A room with a solid block, a second room that cannot be entered, and the outside.
const Drawing kPlan = {"...........",  //
                       ".#########.",  //
                       ".#.....#.#.",  //
                       ".#.###.#.#.",  //
                       ".#.###.#.#.",  //
                       ".#.###.#.#.",  //
                       ".#.....#.#.",  //
                       ".#########.",  //
                       "..........."};
const Eigen::Vector2d kInTheRoom(0.25, 0.25);

TEST(IdealMap, TheTheoreticalMapHasTwoValues) {
  EXPECT_EQ(drawing_of(make_ideal(drawn_grid(kPlan), kInTheRoom).theoretical), kPlan);
}

TEST(IdealMap, TheNormalisedMapKnowsOnlyWhatTheRobotCouldSee) {
  EXPECT_EQ(drawing_of(make_ideal(drawn_grid(kPlan), kInTheRoom).normalised),
            (Drawing{"???????????",  //
                     "?#######???",  //
                     "?#.....#???",  //
                     "?#.###.#???",  //
                     "?#.#?#.#???",  //
                     "?#.###.#???",  //
                     "?#.....#???",  //
                     "?#######???",  //
                     "???????????"}));
}

TEST(IdealMap, WithoutAStartTheLargestFreePieceCounts) {
  const IdealMap ideal = make_ideal(drawn_grid(kPlan), std::nullopt);
  EXPECT_EQ(drawing_of(ideal.normalised).front(), "...........");
  EXPECT_EQ(drawing_of(ideal.normalised)[2], ".#???????#.");
}

TEST(IdealMap, AStartInAWallOrOutsideIsAnError) {
  EXPECT_THROW(make_ideal(drawn_grid(kPlan), Eigen::Vector2d(0.15, 0.25)), Error);
  EXPECT_THROW(make_ideal(drawn_grid(kPlan), Eigen::Vector2d(5, 5)), Error);
  EXPECT_THROW(make_ideal(drawn_grid({"#?"}), std::nullopt), Error);
}

TEST(IdealMap, ForPlanningHiddenObstaclesAreObstaclesAndTheOutsideIsUnknown) {
  const Drawing drawing = drawing_of(planning_map(make_ideal(drawn_grid(kPlan), kInTheRoom)));
  EXPECT_EQ(drawing[0], "???????????");
  EXPECT_EQ(drawing[4], "?#.###.#?#?");
}

CellMask seen_from(const Eigen::Vector2d& position_m, double heading_rad, double fov_rad,
                   double range_m) {
  const ViewPose pose{position_m, heading_rad};
  return visible_cells(drawn_grid(kPlan), {&pose, 1}, fov_rad, range_m);
}

TEST(VisibleCells, RaysEndAtTheFirstObstacle) {
  const IdealMap ideal = restricted_to(make_ideal(drawn_grid(kPlan), kInTheRoom),
                                       seen_from({0.25, 0.45}, 0.0, 2.0 * M_PI, 3.0));
  EXPECT_EQ(drawing_of(ideal.normalised), (Drawing{"???????????",  //
                                                   "??##???????",  //
                                                   "?#..???????",  //
                                                   "?#.#???????",  //
                                                   "?#.#???????",  //
                                                   "?#.#???????",  //
                                                   "?#..???????",  //
                                                   "??##???????",  //
                                                   "???????????"}));
}

TEST(VisibleCells, TheFieldOfViewAndTheRangeLimitThem) {
  const CellMask visible = seen_from({0.25, 0.25}, 0.0, 0.2, 0.25);
  EXPECT_TRUE(visible.contains({3, 2}));
  EXPECT_TRUE(visible.contains({4, 2}));
  EXPECT_FALSE(visible.contains({5, 2}));
  EXPECT_FALSE(visible.contains({2, 3}));
}

TEST(VisibleCells, ImpossibleViewsAreRefused) {
  EXPECT_THROW(seen_from({0.25, 0.25}, 0.0, 0.0, 1.0), UsageError);
  EXPECT_THROW(seen_from({0.25, 0.25}, 0.0, 1.0, -1.0), UsageError);
}

}  // namespace
}  // namespace stereovox
