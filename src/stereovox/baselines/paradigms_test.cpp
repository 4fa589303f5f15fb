#include "stereovox/baselines/paradigms.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "stereovox/baselines/grid_values.h"
#include "stereovox/baselines/random_rooms_for_test.h"
#include "stereovox/core/error.h"
#include "stereovox/navmap/drawn_map_for_test.h"

namespace stereovox {
namespace {

using testing::DoubleNear;
using testing::Pointwise;

struct Vectors {
  nlohmann::json all;
  double cell_m, tolerance;
  Beam beam;
  std::vector<double> centres_m;

  std::vector<double> column(const char* name) const { return all.at(name); }
};

Vectors vectors() {
  std::ifstream file(STEREOVOX_SOURCE_DIR "/src/stereovox/occupancy/testdata/vectors.json");
  const nlohmann::json all = nlohmann::json::parse(file).at("paradigms");
  const Beam beam{.range_m = all.at("reading"), .sigma_m = all.at("sigma"), .has_range = true};
  return {all, all.at("cell"), all.at("tolerance"), beam, all.at("centres")};
}

template <class Function>
std::vector<double> at_centres(const Vectors& v, const Function& function) {
  std::vector<double> values;
  for (const double centre_m : v.centres_m) values.push_back(function(centre_m));
  return values;
}

TEST(MoravecElfes1985, ProfilesAreThoseOfTheVectors) {
  const Vectors v = vectors();
  const MoravecElfesProfile profile = profile_of(v.beam, v.cell_m, MoravecElfes1985Params{});
  const auto empty = at_centres(v, [&](double x_m) { return profile.empty(x_m, 0.0); });
  const auto occupied = at_centres(v, [&](double x_m) { return profile.occupied(x_m, 0.0); });
  EXPECT_THAT(empty, Pointwise(DoubleNear(v.tolerance), v.column("me85_e")));
  EXPECT_THAT(occupied, Pointwise(DoubleNear(v.tolerance), v.column("me85_o")));
}

TEST(MoravecElfes1985, EvidenceFadesTowardsTheEdgeOfTheBeam) {
  const MoravecElfesProfile profile{3.0, 0.2, 0.1, 0.4};
  EXPECT_DOUBLE_EQ(profile.empty(1.0, 0.025), 0.75 * profile.empty(1.0, 0.0));
  EXPECT_DOUBLE_EQ(profile.occupied(3.0, 0.05), 0.0);
}

// The mean of 41 samples that include both ends of the cell, as the vectors were made.
double mean_of_41_samples(const MatthiesElfesProfile& profile, double centre_m, double cell_m) {
  double sum = 0.0;
  for (int i = 0; i <= 40; ++i) sum += profile.at(centre_m + cell_m * (i / 40.0 - 0.5));
  return sum / 41.0;
}

TEST(MatthiesElfes1988, ProfileIsThatOfTheVectors) {
  const Vectors v = vectors();
  const MatthiesElfesProfile profile{v.beam.range_m, v.beam.sigma_m, 0.3, 0.9};
  const auto once =
      at_centres(v, [&](double x_m) { return mean_of_41_samples(profile, x_m, v.cell_m); });
  EXPECT_THAT(once, Pointwise(DoubleNear(v.tolerance), v.column("bayes_cell_avg")));
  const auto thrice = at_centres(v, [&](double x_m) {
    return probability_of(3.0 * log_odds_of(mean_of_41_samples(profile, x_m, v.cell_m)));
  });
  EXPECT_THAT(thrice, Pointwise(DoubleNear(v.tolerance), v.column("bayes_after3")));
}

TEST(MatthiesElfes1988, ClosedFormIsTheMeanOverTheCell) {
  const MatthiesElfesProfile profile{3.0, 1.0 / 14.0, 0.3, 0.9};
  constexpr int kSamples = 20000;
  for (const double centre_m : {1.0, 2.8, 2.95, 3.0, 3.1, 3.5}) {
    double sum = 0.0;
    for (int i = 0; i < kSamples; ++i)
      sum += profile.at(centre_m + 0.25 * ((i + 0.5) / kSamples - 0.5));
    EXPECT_NEAR(profile.mean_over_cell(centre_m, 0.25), sum / kSamples, 1e-8);
  }
}

TEST(Konolige1997, LikelihoodRatiosAreThoseOfTheVectors) {
  const Vectors v = vectors();
  const auto ratios = at_centres(
      v, [&](double x_m) { return likelihood_ratio(x_m, v.cell_m, v.beam, Konolige1997Params{}); });
  EXPECT_THAT(ratios, Pointwise(DoubleNear(v.tolerance), v.column("muriel_lambda")));
}

TEST(Konolige1997, ReadingBehindSomethingSolidIsSpurious) {
  const Konolige1997Params params;
  const Beam beam{.range_m = 3.0, .sigma_m = 0.07, .has_range = true};
  EXPECT_EQ(spurious_probability(0.0, beam, params), 0.0);
  EXPECT_EQ(spurious_probability(1.0, beam, params), 1.0);
  const double true_density = 0.42 / (std::sqrt(2 * std::numbers::pi) * 0.07);
  EXPECT_NEAR(spurious_probability(0.9, beam, params),
              0.9 * 0.00625 / (0.9 * 0.00625 + 0.1 * (0.00625 + true_density)), 1e-12);
}

TEST(Konolige1997, BucketsTellBearingsAndIfAskedRangesApart) {
  Konolige1997Params params;
  EXPECT_EQ(pose_bucket({0, 0}, {1.0, 0.01}, params), 0);
  EXPECT_EQ(pose_bucket({0, 0}, {-1.0, 0.01}, params), 2);
  EXPECT_EQ(pose_bucket({0, 0}, {1.0, -0.01}, params), 4);
  params.pose_buckets = PoseBuckets::eight_bearings_two_ranges;
  EXPECT_EQ(pose_bucket({0, 0}, {1.0, -0.01}, params), 7);
  EXPECT_EQ(pose_bucket({0, 0}, {2.0, -0.01}, params), 15);
}

TEST(Thrun2001, CauseProbabilitiesAreThoseOfTheVectors) {
  const Vectors v = vectors();
  const auto causes = cause_probabilities(3.0, 0.125, std::vector{2.5, 3.125}, Thrun2001Params{});
  EXPECT_THAT(causes, Pointwise(DoubleNear(1e-6), v.column("em_e_rand_max_k1_k2")));
}

TEST(Thrun2001, KeyframesHaveMovedOrTurned) {
  const auto at = [](double x_m, double heading_deg) {
    return PseudoScan{0, {x_m, 0}, heading_deg * std::numbers::pi / 180.0, {}};
  };
  const std::vector scans = {at(0, 179), at(0.1, 179), at(0.15, -172), at(0.15, -170),
                             at(0.36, -170)};
  const auto kept = keyframes(scans, Thrun2001Params{});
  ASSERT_EQ(kept.size(), 3U);
  EXPECT_EQ(kept[1].heading_rad, scans[3].heading_rad);  // 11 degrees, across the half turn
  EXPECT_EQ(kept[2].position_m.x(), 0.36);
}

// One beam along the x axis in a row of cells.
const GridGeometry kRow{.origin_m = {0, 0}, .cell_size_m = 0.25, .width = 16, .height = 1};

PseudoScan one_beam(const Beam& beam) { return {0, {0.01, 0.125}, 0.0, {beam}}; }

template <class Params>
std::string row_of(const std::vector<PseudoScan>& scans) {
  return drawing_of(build_map(scans, kRow, Params{})).front();
}

template <class Params>
class EveryParadigm : public testing::Test {};

struct Names {
  template <class Params>
  static std::string GetName(int) {
    return Params::kName;
  }
};
using AllParadigms = testing::Types<MoravecElfes1985Params, MatthiesElfes1988Params,
                                    Thrun1993Params, Konolige1997Params, Thrun2001Params>;
TYPED_TEST_SUITE(EveryParadigm, AllParadigms, Names);

TYPED_TEST(EveryParadigm, IsUnknownWithoutScans) {
  EXPECT_EQ(row_of<TypeParam>({}), std::string(16, '?'));
}

TYPED_TEST(EveryParadigm, RefusesAGridWithoutCells) {
  EXPECT_THROW(build_map({}, GridGeometry{.width = 0, .height = 3}, TypeParam{}), Error);
}

TYPED_TEST(EveryParadigm, HasParametersThatTheDefaultsSatisfy) {
  Paradigm paradigm = TypeParam{};
  ParameterList list;
  list.one_of("paradigm", paradigm, "older paradigm");
  for (const Parameter& parameter : list.parameters()) parameter.set(parameter.get());
  EXPECT_EQ(list.parameters().front().get(), TypeParam::kName);
}

TYPED_TEST(EveryParadigm, FindsTheWallsAndTheFloorOfARoom) {
  RandomEngine random(5);
  const OccupancyGrid2D room = random_room(random, 0.25);
  const OccupancyGrid2D map =
      build_map(random_scans(room, 200, random), room.geometry, TypeParam{});
  int occupied = 0, found = 0, free = 0, clear = 0;
  for (std::size_t i = 0; i < room.labels.size(); ++i) {
    const bool is_wall = room.labels[i] == CellLabel::occupied;
    (is_wall ? occupied : free) += 1;
    (is_wall ? found : clear) += room.labels[i] == map.labels[i];
  }
  EXPECT_GE(found, 0.9 * occupied);
  EXPECT_GE(clear, 0.6 * free);
}

TYPED_TEST(EveryParadigm, GivesTheSameMapAgain) {
  RandomEngine random(6);
  const OccupancyGrid2D room = random_room(random, 0.25);
  const auto scans = random_scans(room, 10, random);
  EXPECT_EQ(build_map(scans, room.geometry, TypeParam{}).states,
            build_map(scans, room.geometry, TypeParam{}).states);
}

// The paradigms that look at single beams.
template <class Params>
class EveryBeamParadigm : public testing::Test {};
using BeamParadigms = testing::Types<MoravecElfes1985Params, MatthiesElfes1988Params,
                                     Konolige1997Params, Thrun2001Params>;
TYPED_TEST_SUITE(EveryBeamParadigm, BeamParadigms, Names);

TYPED_TEST(EveryBeamParadigm, MarksTheReadingClearsBeforeItAndKnowsNothingBehind) {
  // Two readings in the middle of a cell; what lies farther off than three sigmas stays unknown.
  const Beam beam{.range_m = 2.115, .sigma_m = 0.03, .has_range = true, .free_range_m = 3.5};
  const std::string row = row_of<TypeParam>({one_beam(beam), one_beam(beam)});
  EXPECT_EQ(row.substr(2, 7), "......#");
  EXPECT_EQ(row.substr(10), "??????");
}

TYPED_TEST(EveryBeamParadigm, ClearsUpToTheFreeRangeWithoutAReading) {
  const std::string row = row_of<TypeParam>({one_beam({.free_range_m = 2.115})});
  EXPECT_EQ(row.substr(2, 6), "......");
  EXPECT_EQ(row.substr(9), "???????");
}

TYPED_TEST(EveryBeamParadigm, LearnsNothingFromAnEmptyBeam) {
  EXPECT_EQ(row_of<TypeParam>({one_beam({})}), std::string(16, '?'));
}

double state_at(const OccupancyGrid2D& map, int x) {
  return map.states[static_cast<std::size_t>(x)];
}

TEST(MoravecElfes1985, OccupiedCertaintyGrowsByHalfWithEachEqualBeam) {
  const Beam beam{.range_m = 3.0 - 0.01, .sigma_m = 0.0714, .has_range = true};
  std::vector<PseudoScan> scans;
  for (const double certainty : {0.5, 0.75, 0.875}) {
    scans.push_back(one_beam(beam));
    const OccupancyGrid2D map = build_map(scans, kRow, MoravecElfes1985Params{});
    EXPECT_NEAR(state_at(map, 11), 0.5 * (certainty + 1.0), 1e-3);
    EXPECT_NEAR(state_at(map, 12), 0.5 * (certainty + 1.0), 1e-3);
  }
}

TEST(MatthiesElfes1988, BeamsOfAFrameCountOnceUnlessAskedOtherwise) {
  PseudoScan scan = one_beam({.free_range_m = 2.0});
  scan.beams.resize(3, scan.beams.front());
  EXPECT_NEAR(state_at(build_map(std::vector{scan}, kRow, MatthiesElfes1988Params{}), 3), 0.3,
              1e-6);
  const OccupancyGrid2D map =
      build_map(std::vector{scan}, kRow, MatthiesElfes1988Params{.per_beam = true});
  EXPECT_NEAR(state_at(map, 3), 0.027 / (0.027 + 0.343), 1e-6);
}

TEST(Konolige1997, ReadingsFromOnePlaceCountOnce) {
  const Beam beam{.range_m = 2.115, .sigma_m = 0.03, .has_range = true};
  const std::vector once = {one_beam(beam)},
                    often = {one_beam(beam), one_beam(beam), one_beam(beam)};
  EXPECT_EQ(build_map(once, kRow, Konolige1997Params{}).states,
            build_map(often, kRow, Konolige1997Params{}).states);
}

TEST(Konolige1997, ReadingThroughAWallIsDoubtedIfAsked) {
  const Beam wall{.range_m = 2.115, .sigma_m = 0.03, .has_range = true};
  const Beam behind{.range_m = 3.365, .sigma_m = 0.03, .has_range = true};
  const std::vector scans = {one_beam(wall), one_beam(behind)};
  const double doubted = state_at(build_map(scans, kRow, Konolige1997Params{}), 13);
  const double trusted =
      state_at(build_map(scans, kRow, Konolige1997Params{.specular = false}), 13);
  EXPECT_GT(trusted, 0.98);
  const double share = log_odds_of(doubted) / log_odds_of(trusted);
  EXPECT_GT(share, 0.5);
  EXPECT_LT(share, 0.8);
}

TEST(Thrun2001, ExplainsAWideWallByTheCellsThatSeveralBeamsShare) {
  // Two readings that noise put into neighbouring cells are one obstacle, not two.
  const auto reading = [](double range_m) {
    return one_beam({.range_m = range_m, .sigma_m = 0.12, .has_range = true});
  };
  std::vector<PseudoScan> scans = {reading(2.0), reading(2.1), reading(2.2)};
  Thrun2001Params params;
  params.keyframe_distance_m = 0.0;
  EXPECT_EQ(drawing_of(build_map(scans, kRow, params)).front(), "........#???????");
}

}  // namespace
}  // namespace stereovox
