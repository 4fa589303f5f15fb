#include "stereovox/evaluation/map_score.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "stereovox/evaluation/benchmark_for_test.h"
#include "stereovox/evaluation/draw_score.h"
#include "stereovox/evaluation/map_score_report.h"

namespace stereovox {
namespace {

using testing::HasSubstr;

const MapScoreParams kSmallRobot = {.robot_radius_m = 0.1, .waypoint_offset_m = 0.5};

MapScore benchmark_score() {
  return score_map(benchmark::ideal(), benchmark::generated(), kSmallRobot);
}

TEST(MapScore, HoldsTheFiguresOfTheBenchmarksVector) {
  const nlohmann::json json = to_json(benchmark_score());
  const nlohmann::json expected = benchmark::figures();
  const auto expect = [&](const char* key, double value) {
    EXPECT_NEAR(json.at(key).get<double>(), value, 1e-9) << key;
  };
  expect("ternary_correlation", expected.at("C"));
  expect("ternary_correlation_truncated", 0.8436);
  expect("ternary_map_score_all", 7.8125);
  expect("ternary_map_score_occupied", 375.0 / 28);
  expect("ternary_brier", expected.at("brier"));
  expect("iou_occupied", expected.at("iou"));
  expect("known_fraction", 41.0 / 48);
  expect("free_components_ideal", 1);
}

TEST(MapScore, GradedAndTernaryFormsDifferByTheStatesOnly) {
  OccupancyGrid2D graded = benchmark::generated();
  for (float& state : graded.states) state = state > 0.5F ? 0.8F : 0.1F;
  const CellScore cells = score_map(benchmark::ideal(), graded, kSmallRobot).cells;
  EXPECT_DOUBLE_EQ(cells.ternary.all.sum, 3.75);
  EXPECT_EQ(cells.graded.all.cells, 48);
  // 19 hits 0.2 away, 20 free cells 0.1 away, an invention at 0.8, a wall at 0.1, 7 unknown cells.
  EXPECT_NEAR(cells.graded.all.sum, 19 * 0.04 + 20 * 0.01 + 0.64 + 0.81 + 7 * 0.25, 1e-5);
}

TEST(MapScore, WhatWasNotInViewIsNotHeldAgainstTheMap) {
  const OccupancyGrid2D map = benchmark::generated();
  MapScoreInput input;
  input.visible = cells_labelled(map, CellLabel::unknown);
  for (std::uint8_t& cell : input.visible->cells) cell ^= 1;
  const MapScore score = score_map(benchmark::ideal(), map, kSmallRobot, input);
  EXPECT_DOUBLE_EQ(score.cells.classes.coverage.value(), 41.0 / 48);
  EXPECT_DOUBLE_EQ(score.visible_cells->classes.coverage.value(), 1.0);
  EXPECT_DOUBLE_EQ(score.visible_cells->ternary.all.sum, 2.0);
}

TEST(MapScore, IsTheSameWhereverTheMapsExtentsEnd) {
  const OccupancyGrid2D map = benchmark::generated();
  GridGeometry wide = map.geometry;
  wide.origin_m -= Eigen::Vector2d(2, 1);
  wide.width += 3;
  wide.height += 2;
  const MapScore a = benchmark_score();
  const MapScore b = score_map(benchmark::ideal(), extended_to(map, wide), kSmallRobot, {}, 2);
  EXPECT_EQ(a.cells.ternary.all.sum, b.cells.ternary.all.sum);
  EXPECT_EQ(a.cells.ternary.occupied.cells, b.cells.ternary.occupied.cells);
  EXPECT_EQ(a.cells.classes.mcc, b.cells.classes.mcc);
  EXPECT_EQ(a.paths.unknown_free.false_positives, b.paths.unknown_free.false_positives);
}

TEST(MapScore, AMapThatIsShiftedCanBeAligned) {
  OccupancyGrid2D moved = benchmark::plan();
  moved.geometry.origin_m += Eigen::Vector2d(-3, 2);
  const AlignedMap aligned = aligned_to(benchmark::ideal(), moved, 4.0);
  EXPECT_EQ(aligned.shift_m, Eigen::Vector2d(3, -2));
  EXPECT_DOUBLE_EQ(
      score_map(benchmark::ideal(), aligned.map, kSmallRobot).cells.ternary.correlation.coefficient,
      1.0);
}

TEST(MapScoreReport, KeysAreNamedOnceAndTheSameEverywhere) {
  std::set<std::string> keys;
  for (const ScoreRow& row : map_score_rows()) EXPECT_TRUE(keys.insert(row.key).second) << row.key;
  const nlohmann::json json = to_json(benchmark_score());
  for (const std::string& key : keys) EXPECT_TRUE(json.contains(key)) << key;
  EXPECT_EQ(json.size(), keys.size() + 2);  // and the names of closed doors and of unseen ones
}

TEST(MapScoreReport, WhatTheScoreDoesNotHaveIsNullEmptyOrLeftOut) {
  const MapScore score = benchmark_score();  // without doors, smaller than a window of SSIM
  EXPECT_TRUE(to_json(score).at("doors").is_null());
  EXPECT_TRUE(to_json(score).at("ternary_ssim").is_null());
  EXPECT_THAT(to_text(score), testing::Not(HasSubstr("SSIM")));
  EXPECT_THAT(csv_row(score), HasSubstr(",,"));
}

TEST(MapScoreReport, TextNamesTheFiguresInTheFieldsWords) {
  const std::string text = to_text(benchmark_score());
  EXPECT_THAT(text, HasSubstr("8 x 6 cells of 1 m"));
  EXPECT_THAT(text, HasSubstr("+ correlation with T, ternary"));
  EXPECT_THAT(text, HasSubstr("7.8125 %"));
}

TEST(MapScoreReport, CsvHasAsManyValuesAsNames) {
  const auto commas = [](const std::string& line) { return std::ranges::count(line, ','); };
  EXPECT_EQ(commas(csv_header()), commas(csv_row(benchmark_score())));
  EXPECT_EQ(commas(csv_header()), static_cast<long>(map_score_rows().size()) - 1);
  EXPECT_EQ(csv_row(benchmark_score()).back(), '\n');
}

TEST(DrawScore, ShowsEachKindOfAgreementAndErrorInItsColour) {
  const IdealMap ideal = make_ideal(drawn_grid({"###?",  //
                                                "...?"}),
                                    std::nullopt);
  const cv::Mat3b picture = draw_score(ideal, drawn_grid({"#?..",  //
                                                          "#.??"}));
  const int side = 60;  // of a cell, in a map so small
  const auto at = [&](int column, int row) {
    return picture(16 + row * side + side / 2, 62 + column * side + side / 2);
  };
  EXPECT_EQ(at(0, 0), cv::Vec3b(60, 42, 30));     // hit
  EXPECT_EQ(at(1, 0), cv::Vec3b(0, 159, 230));    // missed
  EXPECT_EQ(at(2, 0), cv::Vec3b(40, 40, 214));    // wrongly free
  EXPECT_EQ(at(3, 0), cv::Vec3b(196, 190, 184));  // beyond
  EXPECT_EQ(at(0, 1), cv::Vec3b(178, 114, 0));    // invented
  EXPECT_EQ(at(1, 1), cv::Vec3b(255, 255, 255));  // free
  EXPECT_EQ(at(2, 1), cv::Vec3b(232, 226, 214));  // unseen
}

}  // namespace
}  // namespace stereovox
