#include "stereovox/navmap/draw_map.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "stereovox/navmap/drawn_map_for_test.h"

namespace stereovox {
namespace {

const cv::Vec3b kOccupied(60, 42, 30), kFree(255, 255, 255), kUnknown(196, 190, 184);
const cv::Vec3b kStart(90, 170, 40);

char character_of(const cv::Vec3b& colour) {
  return colour == kOccupied ? '#' : colour == kFree ? '.' : colour == kUnknown ? '?' : ' ';
}

// The cells' colours met along a row of the picture, repetitions left out.
std::string colours_along(const cv::Mat3b& picture, int row) {
  std::string colours;
  for (int u = 0; u < picture.cols; ++u) {
    const char c = character_of(picture(row, u));
    if (c != ' ' && (colours.empty() || colours.back() != c)) colours += c;
  }
  return colours;
}

int count(const cv::Mat3b& picture, const cv::Vec3b& colour) {
  return static_cast<int>(std::ranges::count(picture, colour));
}

TEST(DrawMap, ShowsTheLargestYAtTheTopAndXToTheRight) {
  const cv::Mat3b picture = draw_map(drawn_grid({"#.?", "?.#"}), {});
  EXPECT_EQ(colours_along(picture, 40), "#.?");
  EXPECT_EQ(colours_along(picture, 100), "?.#");
}

TEST(DrawMap, MagnifiesSmallMapsAndKeepsTheShapeOfCells) {
  const Drawing drawing(40, std::string(40, '#'));
  const cv::Mat3b picture = draw_map(drawn_grid(drawing), {});
  const int side = 40 * (900 / 40);
  EXPECT_GE(count(picture, kOccupied), side * side);
  EXPECT_LT(count(picture, kOccupied), side * side + 20 * 20);  // the legend's swatch
}

TEST(DrawMap, OneOccupiedCellOfALargeMapIsStillSeen) {
  OccupancyGrid2D grid = unknown_grid({{0, 0}, 0.05, 6500, 40}, "test");
  const int swatch_px = count(draw_map(grid, {}), kOccupied);
  grid.labels[grid.position_of({6123, 21})] = CellLabel::occupied;
  const cv::Mat3b picture = draw_map(grid, {});
  EXPECT_EQ(count(picture, kOccupied), swatch_px + 1);
  EXPECT_LT(picture.cols, 3300);
}

TEST(DrawMap, TheWayIsDrawnOverTheMapWithItsStart) {
  const OccupancyGrid2D grid = drawn_grid(Drawing(40, std::string(40, '.')));
  const std::vector<Eigen::Vector2d> way = {{1.0, 1.0}, {3.0, 1.0}};
  EXPECT_EQ(count(draw_map(grid, {}), kStart), 0);
  EXPECT_GT(count(draw_map(grid, way), kStart), 200);  // on the map and in the legend
}

TEST(DrawMap, AWayThatLeavesTheMapIsCutOff) {
  const OccupancyGrid2D grid = drawn_grid(Drawing(10, std::string(10, '.')));
  const std::vector<Eigen::Vector2d> way = {{0.5, 0.5}, {1e12, -1e12}};
  EXPECT_EQ(draw_map(grid, way).size(), draw_map(grid, {}).size());
}

}  // namespace
}  // namespace stereovox
