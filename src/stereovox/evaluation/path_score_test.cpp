#include "stereovox/evaluation/path_score.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "stereovox/evaluation/benchmark_for_test.h"
#include "stereovox/evaluation/value_grid.h"
#include "stereovox/evaluation/voronoi_graph.h"
#include "stereovox/evaluation/voronoi_score.h"
#include "stereovox/navmap/connected_cells.h"

namespace stereovox {
namespace {

const PathScoreParams kByHand = {
    .robot_radius_m = 0.0, .rule = PathRule::breadth_first, .snap_m = 0.0};

std::vector<int> free_positions(const OccupancyGrid2D& map) {
  std::vector<int> positions;
  for (std::size_t i = 0; i < map.labels.size(); ++i)
    if (map.labels[i] == CellLabel::free) positions.push_back(static_cast<int>(i));
  return positions;
}

TEST(PathScore, IsThatOfTheBenchmarksVector) {
  const OccupancyGrid2D plan = benchmark::plan();
  // The vector numbers cells from the top row, so that pairs begin at their upper end.
  std::vector<int> waypoints = free_positions(plan);
  std::ranges::sort(waypoints, {}, [&](int p) {
    const Eigen::Vector2i cell = cell_in(plan.geometry, p);
    return std::pair(-cell.y(), cell.x());
  });
  const PathCounts counts =
      compare_paths(plan, benchmark::generated(), waypoints, kByHand).unknown_blocked;
  const nlohmann::json expected = benchmark::figures().at("paths");
  EXPECT_EQ(counts.ideal_pairs, expected.at("pairs_ideal"));
  EXPECT_EQ(counts.generated_pairs, expected.at("pairs_generated"));
  EXPECT_EQ(counts.false_positives, expected.at("fp"));
  EXPECT_EQ(counts.false_negatives, expected.at("fn"));
  EXPECT_EQ(counts.strict_false_negatives, expected.at("fn_strict"));
  EXPECT_NEAR(counts.false_positive_percent().value(), 50.526, 1e-3);
  EXPECT_NEAR(counts.false_negative_percent().value(), 9.524, 1e-3);
  EXPECT_NEAR(counts.strict_false_negative_percent().value(), 55.238, 1e-3);
}

// Two rooms with a door of `door` cells of 0.25 m in the wall between them.
OccupancyGrid2D two_rooms(int door, char wall = '#') {
  Drawing drawing(21, "#" + std::string(19, '.') + wall + std::string(19, '.') + "#");
  drawing.front() = drawing.back() = std::string(41, '#');
  for (int i = 0; i < door; ++i) drawing[static_cast<std::size_t>(10 + i)][20] = '.';
  return drawn_grid(drawing, 0.25);
}

PathScore score(const OccupancyGrid2D& plan, const OccupancyGrid2D& map, int threads = 1) {
  PathScoreParams params;
  params.threads = threads;
  return score_paths(make_ideal(plan, std::nullopt), map, params);
}

TEST(PathScore, APerfectMapMakesNoErrors) {
  const PathScore s = score(two_rooms(3), two_rooms(3));
  EXPECT_EQ(s.waypoints, 10 * 5);
  EXPECT_EQ(s.unknown_blocked.ideal_pairs, 50 * 49 / 2);
  EXPECT_EQ(s.unknown_blocked.generated_pairs, 50 * 49 / 2);
  EXPECT_EQ(s.unknown_blocked.false_positives, 0);
  EXPECT_EQ(s.unknown_blocked.strict_false_negatives, 0);
  EXPECT_DOUBLE_EQ(s.unknown_blocked.length_ratio().value(), 1.0);
}

TEST(PathScore, AClosedDoorCostsThePathsThroughIt) {
  const PathScore s = score(two_rooms(3), two_rooms(0));
  EXPECT_EQ(s.unknown_blocked.generated_pairs, 2 * (25 * 24 / 2));
  EXPECT_EQ(s.unknown_blocked.false_negatives, 25 * 25);
  EXPECT_EQ(s.unknown_blocked.false_positives, 0);
}

TEST(PathScore, AMissingWallPromisesPathsThatHitIt) {
  const PathScore s = score(two_rooms(3), two_rooms(0, '.'));
  EXPECT_EQ(s.unknown_blocked.false_negatives, 0);
  EXPECT_GT(s.unknown_blocked.false_positives, 25 * 25 / 2);
  EXPECT_LT(s.unknown_blocked.length_ratio().value(), 1.0);
}

TEST(PathScore, UnknownCellsBlockUnlessTheyCountAsFree) {
  const PathScore s = score(two_rooms(3), two_rooms(0, '?'));
  EXPECT_EQ(s.unknown_blocked.false_negatives, 25 * 25);
  EXPECT_EQ(s.unknown_free.false_negatives, 0);
}

TEST(PathScore, AnEmptyMapHasNoPathsToBeWrong) {
  const PathScore s = score(two_rooms(3), unknown_grid(two_rooms(3).geometry, "test"));
  EXPECT_FALSE(s.unknown_blocked.false_positive_percent());
  EXPECT_DOUBLE_EQ(s.unknown_blocked.false_negative_percent().value(), 100.0);
}

TEST(PathScore, DoesNotDependOnTheExtentOfTheMapNorOnTheNumberOfThreads) {
  const OccupancyGrid2D plan = two_rooms(3), map = two_rooms(2, '?');
  GridGeometry wide = map.geometry;
  wide.origin_m -= Eigen::Vector2d(0.75, 1.25);
  wide.width += 9;
  wide.height += 9;
  const PathCounts a = score(plan, map).unknown_free;
  const PathCounts b = score(plan, extended_to(map, wide), 3).unknown_free;
  EXPECT_EQ(a.false_positives, b.false_positives);
  EXPECT_EQ(a.common_pairs, b.common_pairs);
  EXPECT_EQ(a.generated_length_m, b.generated_length_m);
}

TEST(PathScore, WaypointsMoveToTheNearestFreeCellOrAreLeftOut) {
  // Lattice points in the third cell of the upper row, and in the last one, beside a cell shut in.
  const OccupancyGrid2D plan = drawn_grid({"..#...###",  //
                                           "......##.",  //
                                           "......###"},
                                          0.1);
  PathScoreParams params = {.robot_radius_m = 0.0, .waypoint_pitch_m = 0.6};
  params.waypoint_offset_m = 0.25;
  params.snap_m = 0.15;
  EXPECT_EQ(waypoints_of(plan, params), (std::vector{9 + 2}));
}

TEST(VoronoiGraph, RunsAlongTheMiddleOfACorridor) {
  const VoronoiGraph graph = voronoi_graph(drawn_grid({"###############",  //
                                                       "...............",  //
                                                       "...............",  //
                                                       "...............",  //
                                                       "...............",  //
                                                       "...............",  //
                                                       "###############"},
                                                      0.1),
                                           0.1);
  EXPECT_EQ(std::accumulate(graph.lines.cells.begin(), graph.lines.cells.end(), 0), 15);
  EXPECT_EQ(graph.nodes, (std::vector{3 * 15, 3 * 15 + 14}));
}

TEST(VoronoiGraph, SurroundsAPillarWithOneClosedLine) {
  Drawing room(21, "#" + std::string(19, '.') + "#");
  room.front() = room.back() = std::string(21, '#');
  for (std::size_t y = 9; y < 12; ++y) room[y].replace(9, 3, "###");
  const VoronoiGraph graph = voronoi_graph(drawn_grid(room, 0.25), 0.22);
  CellMask others = graph.lines;
  for (std::uint8_t& cell : others.cells) cell ^= 1;
  EXPECT_EQ(connected_cells(others).count(), 2);  // outside and inside of the line
}

VoronoiScore voronoi(const OccupancyGrid2D& plan, const OccupancyGrid2D& map, int max_pairs = 5000,
                     int threads = 1) {
  return score_voronoi_paths(make_ideal(plan, std::nullopt), map,
                             {.max_pairs = max_pairs, .threads = threads});
}

TEST(VoronoiScore, APerfectMapMakesNoErrors) {
  const VoronoiScore s = voronoi(two_rooms(5), two_rooms(5));
  EXPECT_GT(s.false_positive.paths, 10);
  EXPECT_EQ(s.false_positive.invalid, 0);
  EXPECT_EQ(s.false_negative.invalid, 0);
  EXPECT_EQ(s.false_positive.paths, s.false_negative.paths);
}

TEST(VoronoiScore, TellsInventedObstaclesFromMissingOnes) {
  const VoronoiScore blocked = voronoi(two_rooms(5), two_rooms(0));
  EXPECT_GT(blocked.false_negative.invalid_percent().value(), 20.0);
  EXPECT_EQ(blocked.false_positive.invalid, 0);
  EXPECT_GT(voronoi(two_rooms(0), two_rooms(5)).false_positive.invalid_percent().value(), 20.0);
}

TEST(VoronoiScore, DrawsTheSamePairsForTheSameSeed) {
  const VoronoiScore a = voronoi(two_rooms(5), two_rooms(2), 20),
                     b = voronoi(two_rooms(5), two_rooms(2), 20, 3);
  EXPECT_EQ(a.false_negative.paths, 20);
  EXPECT_EQ(a.false_negative.invalid, b.false_negative.invalid);
}

}  // namespace
}  // namespace stereovox
