// The figures that compare two maps cell by cell: correlation, map score, classes, calibration,
// similarity, distances.
#include <gtest/gtest.h>

#include <cmath>

#include "stereovox/evaluation/benchmark_for_test.h"
#include "stereovox/evaluation/calibration.h"
#include "stereovox/evaluation/cell_classes.h"
#include "stereovox/evaluation/correlation.h"
#include "stereovox/evaluation/image_similarity.h"
#include "stereovox/evaluation/obstacle_distance.h"
#include "stereovox/evaluation/squared_error.h"

namespace stereovox {
namespace {

ValueGrid ternary(const OccupancyGrid2D& map) { return value_grid(map, MapForm::ternary); }

TEST(Correlation, IsThatOfTheBenchmarksVector) {
  const Correlation c =
      correlation(ternary(benchmark::ideal().theoretical), ternary(benchmark::generated()));
  EXPECT_NEAR(c.coefficient, benchmark::figures().at("C").get<double>(), 1e-12);
  EXPECT_DOUBLE_EQ(truncated_to_4_decimals(c.coefficient), 0.8436);
}

TEST(Correlation, CountsTheUnionOfBothExtentsAsUnknown) {
  const OccupancyGrid2D a = drawn_grid({"#.?", "?.#"});
  const OccupancyGrid2D b = drawn_grid({"#.", "#.", ".#"}, 0.1, {0.1, -0.2});
  const GridGeometry region = union_of(a.geometry, b.geometry);
  EXPECT_NEAR(
      correlation(ternary(a), ternary(b)).coefficient,
      correlation(ternary(extended_to(a, region)), ternary(extended_to(b, region))).coefficient,
      1e-14);
}

TEST(Correlation, OfAMapThatIsTheSameEverywhereIsZeroAndSaysSo) {
  const Correlation c = correlation(ternary(drawn_grid({"##"})), ternary(drawn_grid({".#"})));
  EXPECT_EQ(c.coefficient, 0.0);
  EXPECT_TRUE(c.is_flat);
}

TEST(Correlation, TheBestShiftBringsAMovedMapBack) {
  const OccupancyGrid2D truth = benchmark::plan();
  OccupancyGrid2D moved = truth;
  moved.geometry.origin_m += Eigen::Vector2d(2, -1);
  const BestShift best = best_shift(ternary(truth), ternary(moved), 2);
  EXPECT_EQ(best.shift_cells, Eigen::Vector2i(-2, 1));
  EXPECT_DOUBLE_EQ(best.coefficient, 1.0);
}

TEST(Correlation, AMapThatFitsNowhereBetterIsNotShifted) {
  const BestShift best =
      best_shift(ternary(benchmark::plan()), ternary(drawn_grid({"??", "??"}, 1.0)), 3);
  EXPECT_EQ(best.shift_cells, Eigen::Vector2i(0, 0));
}

TEST(MapError, IsThatOfTheBenchmarksVector) {
  const ValueGrid n = ternary(benchmark::ideal().normalised), m = ternary(benchmark::generated());
  const MapError all = error_over_all(n, m), occupied = error_over_occupied(n, m);
  EXPECT_EQ(std::pair(all.sum, all.cells), std::pair(3.75, 48));
  EXPECT_EQ(std::pair(occupied.sum, occupied.cells), std::pair(3.75, 28));
  EXPECT_DOUBLE_EQ(all.percent().value(), 7.8125);
  EXPECT_NEAR(occupied.percent().value(), 13.392857, 1e-6);
  EXPECT_NEAR(match_bits(n, m).sum, benchmark::figures().at("match_bits_clip01").get<double>(),
              1e-9);
  EXPECT_EQ(match_bits(n, m).cells, 41);
}

TEST(MapError, LeavesOutCellsThatBothMapsDoNotKnow) {
  const ValueGrid n = ternary(drawn_grid({"?#."})), m = ternary(drawn_grid({"??."}));
  EXPECT_EQ(error_over_all(n, m).cells, 2);
  EXPECT_EQ(error_over_occupied(n, m).cells, 1);
  EXPECT_FALSE(error_over_all(ternary(drawn_grid({"?"})), ternary(drawn_grid({"?"}))).percent());
}

TEST(MapError, SumsThatAreRoundingOnlyAreZero) {
  OccupancyGrid2D map = drawn_grid({"#"});
  map.states[0] = 0.998F;
  EXPECT_EQ(error_over_all(ternary(drawn_grid({"#"})), value_grid(map, MapForm::graded)).sum, 0.0);
}

TEST(CellClasses, AreThoseOfTheBenchmarksVector) {
  const CellClasses c = score_classes(benchmark::ideal().normalised, benchmark::generated());
  const nlohmann::json figures = benchmark::figures();
  EXPECT_EQ((nlohmann::json{c.true_positive, c.false_positive, c.false_negative, c.true_negative}),
            figures.at("tp_fp_fn_tn"));
  EXPECT_DOUBLE_EQ(c.precision.value(), 0.95);
  EXPECT_NEAR(c.recall.value(), 0.703704, 1e-6);
  EXPECT_NEAR(c.f1.value(), figures.at("f1").get<double>(), 1e-12);
  EXPECT_NEAR(c.iou_occupied.value(), figures.at("iou").get<double>(), 1e-12);
  EXPECT_NEAR(c.kappa.value(), figures.at("kappa").get<double>(), 1e-12);
  EXPECT_NEAR(c.mcc.value(), figures.at("mcc").get<double>(), 1e-12);
  EXPECT_NEAR(c.known_fraction, 0.854167, 1e-6);
}

const Drawing kTruth = {"#####???",  //
                        "#....???",  //
                        "#....???"};
const Drawing kFound = {".####??#",  //
                        "?#...???",  //
                        "?..#????"};

CellClasses drawn_classes() { return score_classes(drawn_grid(kTruth), drawn_grid(kFound)); }

TEST(CellClasses, CountACellBesideTheTrueOneWithinTheTolerance) {
  const CellClasses c = drawn_classes();
  EXPECT_EQ(c.true_positive, 4);
  EXPECT_EQ(c.false_positive, 2);
  EXPECT_EQ(c.false_negative, 3);
  EXPECT_DOUBLE_EQ(c.tolerant_precision.value(), 5.0 / 6.0);  // the one in the middle is invented
  EXPECT_DOUBLE_EQ(c.tolerant_recall.value(), 7.0 / 7.0);     // all lie beside a found one
}

TEST(CellClasses, TellWallsCalledFreeFromWallsNotSeen) {
  const CellClasses c = drawn_classes();
  EXPECT_DOUBLE_EQ(c.false_free_rate.value(), 1.0 / 7.0);
  EXPECT_DOUBLE_EQ(c.coverage.value(), 12.0 / 15.0);
  EXPECT_EQ(c.occupied_outside, 1);
  EXPECT_DOUBLE_EQ(c.iou_free.value(), 5.0 / 9.0);
}

TEST(CellClasses, MacroF1IsTheMeanOfTheThreeClasses) {
  // Occupied: 4 agree of 7 and 7; free: 5 of 8 and 6; unknown: 8 of 9 and 11.
  EXPECT_NEAR(drawn_classes().macro_f1.value(), (8.0 / 14 + 10.0 / 14 + 16.0 / 20) / 3, 1e-12);
}

TEST(CellClasses, FiguresWithoutCellsAreAbsent) {
  const CellClasses c = score_classes(drawn_grid({"??"}), drawn_grid({"#."}));
  EXPECT_FALSE(c.precision || c.recall || c.kappa || c.mcc || c.coverage || c.false_free_rate);
}

TEST(Calibration, MeasuresHowValuesAndTruthAgree) {
  const Calibration c = score_calibration({{0.9, true}, {0.9, false}, {0.1, false}, {0.5, true}});
  EXPECT_DOUBLE_EQ(c.brier.value(), (0.01 + 0.81 + 0.01 + 0.25) / 4);
  EXPECT_NEAR(c.log_loss.value(),
              -(std::log(0.9) + std::log(0.1) + std::log(0.9) + std::log(0.5)) / 4, 1e-12);
  // Pairs of occupied and free: 0.9 ties 0.9 and beats 0.1; 0.5 loses to 0.9 and beats 0.1.
  EXPECT_DOUBLE_EQ(c.auc.value(), 2.5 / 4);
  // Bins of 0.9 (two cells, one occupied), 0.1 (none) and 0.5 (one).
  EXPECT_NEAR(c.expected_error.value(), (0.8 + 0.1 + 0.5) / 4, 1e-12);
}

TEST(Calibration, ClipsCertainErrorsAndHasNoAucOfOneClass) {
  const Calibration c = score_calibration({{0.0, true}});
  EXPECT_NEAR(c.log_loss.value(), -std::log(0.01), 1e-12);
  EXPECT_FALSE(c.auc);
  EXPECT_FALSE(score_calibration({}).brier);
}

OccupancyGrid2D checkered(int side, int phase) {
  Drawing drawing(static_cast<std::size_t>(side), std::string(static_cast<std::size_t>(side), '.'));
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      if ((x + y + phase) % 2 == 0)
        drawing[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)] = '#';
  return drawn_grid(drawing);
}

TEST(StructuralSimilarity, IsOneForEqualMapsAndAsWorkedOutForOppositeOnes) {
  const ValueGrid board = ternary(checkered(7, 0)), opposite = ternary(checkered(7, 1));
  EXPECT_NEAR(structural_similarity(board, board).value(), 1.0, 1e-12);
  // 25 of 49 cells against the other 24: both variances p q, the covariance -p q.
  const double p = 25.0 / 49, q = 24.0 / 49, c1 = 1e-4, c2 = 9e-4;
  EXPECT_NEAR(structural_similarity(board, opposite).value(),
              (2 * p * q + c1) * (-2 * p * q + c2) / ((p * p + q * q + c1) * (2 * p * q + c2)),
              1e-12);
}

TEST(StructuralSimilarity, IsAMeanOverAllWindowsAndAbsentWithoutOne) {
  EXPECT_NEAR(structural_similarity(ternary(checkered(9, 0)), ternary(checkered(9, 0))).value(),
              1.0, 1e-12);
  EXPECT_FALSE(structural_similarity(ternary(checkered(6, 0)), ternary(checkered(6, 0))));
}

TEST(ObstacleDistance, TellsWhatIsMissingFromWhatWasInvented) {
  const IdealMap ideal = make_ideal(drawn_grid({"#....#"}, 0.25), std::nullopt);
  const ObstacleDistance d = score_obstacle_distance(ideal, drawn_grid({"#.#..."}, 0.25));
  EXPECT_DOUBLE_EQ(d.to_generated_m.value(), (0.0 + 0.75) / 2);
  EXPECT_DOUBLE_EQ(d.to_ideal_m.value(), (0.0 + 0.5) / 2);
  EXPECT_DOUBLE_EQ(d.chamfer_m.value(), 0.625);
  EXPECT_DOUBLE_EQ(d.hausdorff95_m.value(), 0.75);
  EXPECT_FALSE(score_obstacle_distance(ideal, drawn_grid({"......"}, 0.25)).chamfer_m);
}

TEST(ObstacleDistance, HiddenInsidesOfSolidsAreNoInventionButAreNotAskedFor) {
  const Drawing solid = {".....", ".###.", ".###.", ".###.", "....."};
  const IdealMap ideal = make_ideal(drawn_grid(solid, 1.0), std::nullopt);
  const Drawing middle = {".....", ".....", "..#..", ".....", "....."};
  const ObstacleDistance d = score_obstacle_distance(ideal, drawn_grid(middle, 1.0));
  EXPECT_DOUBLE_EQ(d.to_ideal_m.value(), 0.0);
  EXPECT_DOUBLE_EQ(d.to_generated_m.value(), (4 + 4 * std::sqrt(2.0)) / 8);
}

}  // namespace
}  // namespace stereovox
