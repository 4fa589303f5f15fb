#include "stereovox/evaluation/score_report.h"

#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>

namespace stereovox {
namespace {

TrajectoryScore some_trajectory_score() {
  TrajectoryScore score;
  score.ate_m = statistics_of(std::array{3.0, 4.0});
  score.rpe_translation_m = statistics_of(std::array{0.25});
  score.segments = {{.length_m = 5, .segments = 2, .t_rel_percent = 1.5, .r_rel_deg_per_m = 0.125},
                    {.length_m = 10}};
  score.segments_overall = {.segments = 2, .t_rel_percent = 1.5, .r_rel_deg_per_m = 0.125};
  score.path_length_m = 8.0;
  score.end_drift_m = 0.5;
  score.end_drift_percent = 6.25;
  score.matched = 2;
  score.unmatched_truth = 7;
  return score;
}

TEST(ScoreReport, TrajectoryAsJsonHasFieldNamesAndNullForWhatWasNotMeasured) {
  const nlohmann::json json = to_json(some_trajectory_score());
  EXPECT_EQ(json["alignment"], "se3");
  EXPECT_EQ(json["ate_m"]["max"], 4.0);
  EXPECT_EQ(json["rpe_translation_m"]["count"], 1);
  EXPECT_TRUE(json["rpe_rotation_deg"].is_null());
  ASSERT_EQ(json["segments"].size(), 1U);
  EXPECT_EQ(json["segments"][0]["length_m"], 5.0);
  EXPECT_EQ(json["segments_overall"]["t_rel_percent"], 1.5);
  EXPECT_EQ(json["unmatched_truth"], 7);
}

TEST(ScoreReport, TrajectoryAsTextIsATable) {
  EXPECT_EQ(to_text(some_trajectory_score()),
            R"(2 poses matched; without partner: 7 of the truth, 0 of the estimate
                           rmse     mean   median      std      max    count
ATE (se3) m              3.5355   3.5000   3.5000   0.5000   4.0000        2
RPE translation m        0.2500   0.2500   0.2500   0.0000   0.2500        1
RPE rotation deg              -
segments                t_rel %   r_rel deg/m    count
  5 m                     1.500       0.12500        2
  10 m                        -             -        0
  all lengths             1.500       0.12500        2
end drift 0.500 m = 6.25 % of 8.00 m
)");
}

DisparityScore some_disparity_score() {
  return {.counted_px = 200,
          .density_percent = 50,
          .missing_is_bad = {{60, 58, 55, 52.5}, 51},
          .valid_only = {{20, 16, 10, 5}, 2},
          .mae_px = 0.5,
          .rms_px = 0.75,
          .bias_px = -0.25};
}

TEST(ScoreReport, DisparityAsJsonNamesEachThreshold) {
  const nlohmann::json json = to_json(some_disparity_score());
  EXPECT_EQ(json["missing_is_bad"]["bad_0.5_percent"], 60.0);
  EXPECT_EQ(json["valid_only"]["bad_3_percent"], 5.0);
  EXPECT_EQ(json["valid_only"]["d1_percent"], 2.0);
  EXPECT_EQ(json["bias_px"], -0.25);
}

TEST(ScoreReport, DisparityAsTextIsATable) {
  EXPECT_EQ(to_text(some_disparity_score()),
            R"(200 pixels counted, 50.00 % of them with a disparity
wrong pixels %          bad-0.5    bad-1    bad-2    bad-3       D1
missing counts as bad     60.00    58.00    55.00    52.50    51.00
valid only                20.00    16.00    10.00     5.00     2.00
error px: mean absolute 0.500, rms 0.750, bias -0.250
)");
}

TEST(ScoreReport, AnEmptyDisparityImageHasNoErrorsToReport) {
  const DisparityScore empty{.counted_px = 4, .missing_is_bad = {{100, 100, 100, 100}, 100}};
  EXPECT_TRUE(to_json(empty)["mae_px"].is_null());
  EXPECT_TRUE(to_json(empty)["valid_only"].is_null());
  EXPECT_EQ(to_text(empty).find("rms"), std::string::npos);
}

}  // namespace
}  // namespace stereovox
