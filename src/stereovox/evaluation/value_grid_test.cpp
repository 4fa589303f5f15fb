#include "stereovox/evaluation/value_grid.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stereovox/core/error.h"
#include "stereovox/navmap/drawn_map_for_test.h"

namespace stereovox {
namespace {

template <class Action>
std::string complaint_of(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(ValueGrid, UnknownIsOneHalfWhateverItsState) {
  OccupancyGrid2D map = drawn_grid({"#.?."});
  map.states = {0.9F, 0.25F, 0.9F, 0.5F};
  EXPECT_THAT(value_grid(map, MapForm::ternary).values, testing::ElementsAre(1, 0, 0.5, 0));
  EXPECT_THAT(value_grid(map, MapForm::graded).values,
              testing::Pointwise(testing::DoubleNear(1e-6), {0.9, 0.25, 0.5, 0.5}));
}

TEST(ValueGrid, TheUnionHoldsBothMapsAndWhatIsBeyondAMapIsUnknown) {
  const OccupancyGrid2D a = drawn_grid({"#."}, 0.25, {1.0, 1.0});
  const OccupancyGrid2D b = drawn_grid({".#"}, 0.25, {1.25, 0.75});
  const GridGeometry region = union_of(a.geometry, b.geometry);
  EXPECT_EQ(drawing_of(extended_to(a, region)), (Drawing{"#.?",  //
                                                         "???"}));
  EXPECT_EQ(drawing_of(extended_to(b, region)), (Drawing{"???",  //
                                                         "?.#"}));
  EXPECT_EQ(drawing_of(extended_to(b, b.geometry)), drawing_of(b));
}

TEST(ValueGrid, MapsOfDifferentLatticesAreRefusedWithTheNumbers) {
  const GridGeometry a{{0, 0}, 0.25, 2, 2};
  EXPECT_EQ(complaint_of([&] {
              lattice_offset(a, {{0, 0}, 0.2, 2, 2});
            }),
            "maps: cells of 0.25 m and of 0.2 m cannot be compared");
  EXPECT_EQ(complaint_of([&] {
              lattice_offset(a, {{0.3, 0}, 0.25, 2, 2});
            }),
            "maps: the origins lie (1.2, 0) cells apart, not whole cells");
  EXPECT_EQ(complaint_of([&] {
              union_of(a, {{1e8, 0}, 0.25, 2, 2});
            }),
            "maps: together they stretch over 400000002 x 2 cells, at most 64000000");
  EXPECT_NE(complaint_of([&] { lattice_offset(a, {{1e300, 0}, 0.25, 2, 2}); }), "");
}

TEST(ValueGrid, OriginsMayDifferByAThousandthOfACell) {
  EXPECT_EQ(lattice_offset({{0, 0}, 0.25, 2, 2}, {{0.50002, -0.25}, 0.25, 2, 2}),
            Eigen::Vector2i(2, -1));
}

TEST(ValueGrid, ResamplingTakesTheCellInWhichTheNewCentreLies) {
  const OccupancyGrid2D coarse = drawn_grid({"#.", "?#"}, 0.2);
  EXPECT_EQ(drawing_of(resampled_to(coarse, {{0, 0}, 0.1, 9, 9})), (Drawing{"##..",  //
                                                                            "##..",  //
                                                                            "??##",  //
                                                                            "??##"}));
  EXPECT_EQ(drawing_of(resampled_to(coarse, {{0.05, 0.0}, 0.2, 1, 1})), (Drawing{"?#.", "??#"}));
}

}  // namespace
}  // namespace stereovox
