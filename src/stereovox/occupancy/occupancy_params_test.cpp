#include "stereovox/occupancy/occupancy_params.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stereovox/core/error.h"

namespace stereovox {
namespace {

std::string value_of(const std::string& path, OccupancyParams params) {
  const ParameterList list = parameters_of(params);
  for (const Parameter& p : list.parameters())
    if (p.path == path) return p.get();
  return "";
}

OccupancyParams with(const Settings& settings) {
  OccupancyParams params;
  apply_settings(settings, params);
  return params;
}

TEST(OccupancyParams, DefaultsLieWithinTheirRanges) {
  for (const char* preset : {"literal", "corrected", "tuned"}) {
    OccupancyParams params = with({{"preset", preset}});
    const ParameterList list = parameters_of(params);
    for (const Parameter& p : list.parameters()) {
      if (p.selects) continue;
      EXPECT_NO_THROW(p.set(p.get())) << preset << " " << p.path;
    }
  }
}

TEST(OccupancyParams, CorrectedIsTheDefault) {
  EXPECT_EQ(value_of("preset", {}), "corrected");
  OccupancyParams defaults, corrected = with({{"preset", "literal"}, {"preset", "corrected"}});
  const ParameterList a = parameters_of(defaults), b = parameters_of(corrected);
  ASSERT_EQ(a.parameters().size(), b.parameters().size());
  for (std::size_t i = 0; i < a.parameters().size(); ++i)
    EXPECT_EQ(a.parameters()[i].get(), b.parameters()[i].get()) << a.parameters()[i].path;
}

TEST(OccupancyParams, PresetsSetTheDecisionTable) {
  const struct {
    const char *path, *literal, *corrected;
  } table[] = {
      {"error_model.noise", "printed", "corrected"},
      {"error_model.depth_variance", "printed", "exact"},
      {"observation.type", "literal", "min_ramp"},
      {"union.type", "max", "rank"},
      {"density.type", "printed", "relative"},
      {"observed_set", "frustum", "raycast"},
      {"homogeneity.neighbours", "6", "6"},
      {"homogeneity.unobserved", "zero", "excluded"},
      {"homogeneity.min_homogeneity", "0", "0.1"},
      {"update.type", "literal", "saturating"},
  };
  for (const auto& row : table) {
    EXPECT_EQ(value_of(row.path, with({{"preset", "literal"}})), row.literal) << row.path;
    EXPECT_EQ(value_of(row.path, with({{"preset", "corrected"}})), row.corrected) << row.path;
  }
}

TEST(OccupancyParams, AChoiceRefinesAPresetWhateverTheOrder) {
  const OccupancyParams params = with({{"initial_state", "0.5"}, {"preset", "literal"}});
  EXPECT_EQ(value_of("initial_state", params), "0.5");
  EXPECT_EQ(value_of("update.type", params), "literal");
}

TEST(OccupancyParams, TunedHasTheChoicesOfCorrectedAndOtherNumbers) {
  OccupancyParams tuned = with({{"preset", "tuned"}}), corrected;
  const ParameterList a = parameters_of(tuned), b = parameters_of(corrected);
  ASSERT_EQ(a.parameters().size(), b.parameters().size());
  std::string different;
  for (std::size_t i = 0; i < a.parameters().size(); ++i)
    if (a.parameters()[i].get() != b.parameters()[i].get())
      different += a.parameters()[i].path + " ";
  EXPECT_EQ(different,
            "preset max_sigma_half_voxels max_sigma_m follow_floor smoothing.radius_px union.quantile "
            "union.majority density.lambda observed_set free_margin_sigmas "
            "homogeneity.min_homogeneity update.max_credibility "
            "initial_state ");
}

TEST(OccupancyParams, APresetLeavesSizesAlone) {
  EXPECT_EQ(value_of("voxel_size_m", with({{"voxel_size_m", "0.25"}, {"preset", "literal"}})),
            "0.25");
}

TEST(OccupancyParams, UnknownNamesAreRefused) {
  EXPECT_THROW(with({{"observation.type", "ball"}}), UsageError);
  EXPECT_THROW(with({{"voxel_size_m", "nan"}}), UsageError);
}

}  // namespace
}  // namespace stereovox
