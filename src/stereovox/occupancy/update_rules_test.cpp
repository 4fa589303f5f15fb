#include "stereovox/occupancy/update_rules.h"

#include <gtest/gtest.h>

#include "stereovox/occupancy/homogeneity.h"
#include "stereovox/occupancy/vectors_for_test.h"
#include "stereovox/occupancy/voxel_update.h"

namespace stereovox {
namespace {

const double kPrintedScale = 1.0 / kSqrtTwoPi;

// Credibility of the n-th observation of a voxel, `dt_s` after the one before.
template <class Rule>
double credibility_after(const Rule& rule, int prior, double dt_s, double H, double min_homogeneity,
                         std::uint32_t frames_before = 0) {
  return rule.credibility({.prior_observations = prior,
                           .homogeneity = homogeneity({.min_homogeneity = min_homogeneity}, H),
                           .age_factor = prior == 0 ? 1.0 : rule.age_factor(dt_s),
                           .frames_before = frames_before});
}

TEST(UpdateRules, CredibilityIsThatOfTheVectors) {
  const auto rows = vectors::section("credibility");
  ASSERT_EQ(rows.size(), 100U);
  for (const auto& row : rows) {
    SCOPED_TRACE(row.dump());
    const auto k = [&](const auto& rule, double min_homogeneity) {
      return credibility_after(rule, row.at("n_prior"), row.at("dt"), row.at("H"), min_homogeneity);
    };
    const double literal = row.at("k_literal_unclamped_t0_10_2sig2_10");
    EXPECT_NEAR(k(LiteralRule{}, 0.0), std::min(1.0, literal), 1e-12);
    const SaturatingRule slow{.full_observations = 10};
    EXPECT_NEAR(k(slow, 0.1), row.at("k_corrected_kmax_0p2").get<double>(), 1e-12);
    const SaturatingRule printed_scale{.max_credibility = kPrintedScale, .full_observations = 10};
    EXPECT_NEAR(k(printed_scale, 0.1), row.at("k_corrected_kmax_inv_sqrt2pi").get<double>(), 1e-12);
  }
}

TEST(UpdateRules, StepResponsesAreThoseOfTheVectors) {
  const auto series = vectors::section("step_response");
  ASSERT_EQ(series.size(), 5U);
  for (const auto& [name, states] : series.items()) {
    SCOPED_TRACE(name);
    const int full = std::stoi(name.substr(name.find("N0=") + 3));
    const bool is_default_scale = name.find("kmax=0.2000") != std::string::npos;
    const SaturatingRule rule{.max_credibility = is_default_scale ? 0.2 : kPrintedScale,
                              .full_observations = full};
    Voxel voxel;
    for (std::size_t frame = 0; frame < states.size(); ++frame) {
      const double k = credibility_after(rule, voxel.observations, 0.2, 0.2, 0.1);
      update_voxel(1.0F, k, 0.0, std::uint32_t(200 * frame), voxel);
      EXPECT_NEAR(voxel.state, states[frame].get<double>(), 1e-6);
    }
  }
}

// Frames until a voxel that is hit in each of them passes 0.5.
template <class Rule>
int frames_to_half(const Rule& rule, std::uint32_t first_frame) {
  double state = 0.0;
  int seen = 0;
  while (state <= 0.5) {
    const double k =
        credibility_after(rule, seen, 0.2, 0.0, 0.0, first_frame + std::uint32_t(seen));
    state = (1.0 - k) * state + k;
    ++seen;
  }
  return seen;
}

TEST(UpdateRules, FrequencyPunishesWhatIsSeenLate) {
  EXPECT_EQ(frames_to_half(FrequencyRule{}, 0), 2);
  EXPECT_EQ(frames_to_half(FrequencyRule{}, 1000), 60);
  EXPECT_EQ(frames_to_half(FrequencyRule{}, 10000), 187);
}

TEST(UpdateRules, LiteralScaledNeedsAboutThirtySevenFrames) {
  EXPECT_NEAR(frames_to_half(LiteralScaledRule{}, 0), 38, 1);
}

TEST(UpdateRules, LiteralIgnoresTheFirstObservationAndForgetsEverythingInTheEnd) {
  EXPECT_EQ(credibility_after(LiteralRule{}, 0, 0.2, 0.0, 0.0), 0.0);
  EXPECT_EQ(credibility_after(LiteralRule{}, 60000, 0.2, 0.0, 0.0), 1.0);
}

TEST(UpdateRules, AGapDiscountsTheNewObservationOrTheOldState) {
  const SaturatingRule discount;
  const SaturatingRule decay{.age_mode = AgeMode::prior_decay};
  EXPECT_NEAR(credibility_after(discount, 9, 10.0, 0.0, 0.1), 0.2 * std::exp(-1.0), 1e-12);
  EXPECT_NEAR(credibility_after(decay, 9, 1.0, 0.0, 0.1), 1.0 - 0.8 * std::exp(-0.1), 1e-12);
  EXPECT_DOUBLE_EQ(credibility_after(decay, 9, 100.0, 0.0, 0.1), 0.6);
  EXPECT_DOUBLE_EQ(credibility_after(decay, 9, 0.0, 0.0, 0.1), 0.2);
}

TEST(UpdateRules, TheCountOfObservationsSaturates) {
  Voxel voxel{.state = 0.5F, .last_seen_ms = 0, .observations = 65535};
  update_voxel(1.0F, 0.1, 0.0, 7, voxel);
  EXPECT_EQ(voxel.observations, 65535);
  EXPECT_EQ(voxel.last_seen_ms, 7U);
}

TEST(UpdateRules, TheFirstObservationStartsFromTheInitialState) {
  Voxel voxel;
  update_voxel(1.0F, 0.2, 0.5, 0, voxel);
  EXPECT_FLOAT_EQ(voxel.state, 0.6F);
}

}  // namespace
}  // namespace stereovox
