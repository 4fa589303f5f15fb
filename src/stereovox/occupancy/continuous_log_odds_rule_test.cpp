#include "stereovox/occupancy/continuous_log_odds_rule.h"

#include <gtest/gtest.h>

#include <cmath>

#include "stereovox/occupancy/vectors_for_test.h"

namespace stereovox {
namespace {

double log_odds(double probability) { return std::log(probability / (1.0 - probability)); }

TEST(ContinuousLogOddsRule, TheIncrementsAreThoseOfTheVectors) {
  const auto vectors = vectors::section("paradigms");
  const double range_m = vectors.at("reading"), sigma_m = vectors.at("sigma");
  const auto& centres_m = vectors.at("centres");
  const auto& expected = vectors.at("continuous_ray_logodds");
  ASSERT_EQ(centres_m.size(), expected.size());
  const ContinuousLogOddsRule rule;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const double f = (centres_m[i].get<double>() - range_m) / sigma_m;
    EXPECT_NEAR(log_odds(rule.evidence(profile_at(f))), expected[i].get<double>(), 2e-4) << i;
  }
}

TEST(ContinuousLogOddsRule, EvidenceAddsUpInLogOdds) {
  const ContinuousLogOddsRule rule;
  VoxelBelief belief = kNoBelief;
  for (const float profile : {0.7F, 0.2F, 0.9F}) belief = rule.after(belief, profile);
  const double sum =
      log_odds(rule.evidence(0.7)) + log_odds(rule.evidence(0.2)) + log_odds(rule.evidence(0.9));
  EXPECT_NEAR(log_odds(belief.state), sum, 1e-6);
}

TEST(ContinuousLogOddsRule, StaysWithinItsLimits) {
  const ContinuousLogOddsRule rule;
  VoxelBelief belief = kNoBelief;
  for (int i = 0; i < 50; ++i) belief = rule.after(belief, 0.9F);
  EXPECT_EQ(belief.state, rule.limits.max_probability);
  for (int i = 0; i < 50; ++i) belief = rule.after(belief, 0.0F);
  EXPECT_EQ(belief.state, rule.limits.min_probability);
}

}  // namespace
}  // namespace stereovox
