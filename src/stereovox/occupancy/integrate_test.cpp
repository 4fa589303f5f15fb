#include "stereovox/occupancy/integrate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <sstream>

#include "stereovox/core/error.h"
#include "stereovox/occupancy/integrate_reference.h"
#include "stereovox/occupancy/scene_for_test.h"
#include "stereovox/occupancy/voxel_map_file.h"

namespace stereovox {
namespace {

using Integrate = decltype(&integrate);

struct Result {
  std::string map_bytes;  // everything the map holds, bit by bit
  std::vector<FrameUpdate> updates;
};

Result run(Integrate how, const std::vector<scene::Frame>& drive, const OccupancyParams& params,
           int threads) {
  VoxelMap map(params.voxel_size_m, 0.1);
  Result result;
  for (const scene::Frame& f : drive)
    result.updates.push_back(
        how(f.disparity, scene::camera(), f.T_world_camera, f.stamp_ns, params, threads, map));
  std::ostringstream out;
  write_voxel_map(out, map);
  result.map_bytes = out.str();
  return result;
}

void expect_equal(const Result& a, const Result& b) {
  EXPECT_TRUE(a.map_bytes == b.map_bytes) << "maps differ";
  ASSERT_EQ(a.updates.size(), b.updates.size());
  for (std::size_t i = 0; i < a.updates.size(); ++i) {
    EXPECT_EQ(a.updates[i].hit_voxels, b.updates[i].hit_voxels) << "frame " << i;
    EXPECT_EQ(a.updates[i].free_voxels, b.updates[i].free_voxels) << "frame " << i;
    EXPECT_EQ(a.updates[i].points_used, b.updates[i].points_used) << "frame " << i;
    EXPECT_EQ(a.updates[i].hits, b.updates[i].hits) << "frame " << i;
  }
}

// Each alternative of each choice that these parameters offer, one at a time.
std::vector<Settings> single_choices(OccupancyParams params) {
  std::vector<Settings> choices = {{}};
  const ParameterList list = parameters_of(params);
  for (const Parameter& p : list.parameters()) {
    if (p.path == "preset" || p.range.find(" | ") == std::string::npos) continue;
    std::istringstream words(p.range);
    for (std::string word; words >> word;)
      if (word != "|") choices.push_back({{p.path, word}});
  }
  return choices;
}

const std::vector<Settings> kFurtherChoices = {
    {{"initial_state", "0.5"}, {"pixel_step", "2"}, {"free_margin_sigmas", "2"}},
    {{"union.type", "rank"}, {"union.quantile", "0.5"}, {"valid_fraction", "0.7"}},
    {{"update.type", "saturating"}, {"update.age_mode", "prior_decay"}},
    {{"observation.type", "euclid_continuous"}, {"observation.distance_error", "printed"}},
    {{"update.type", "continuous_log_odds"}, {"union.type", "max"}, {"pixel_step", "3"}},
    {{"update.type", "continuous_log_odds"}, {"update.min_sigma_half_voxels", "0"}},
    {{"update.type", "visibility"}, {"update.unknown_occupancy", "0.02"}},
    {{"observed_set", "projected"}, {"ray_step_px", "1"}, {"union.type", "rank"}},
    {{"observed_set", "projected"}, {"update.type", "continuous_log_odds"}},
    {{"observation.type", "point"}, {"union.type", "rank"}, {"update.type", "log_odds"}},
    {{"observation.type", "min_ramp"}, {"union.type", "rank"}, {"union.majority", "0.5"}},
    {{"observation.type", "min_ramp"}, {"union.type", "rank"}, {"max_sigma_half_voxels", "30"}},
    {{"update.type", "dempster_shafer"}, {"update.conflict", "yager"}},
    {{"smoothing.radius_px", "2"}, {"smoothing.gate_sigmas", "3"}},
    {{"smoothing.radius_px", "1"}, {"pixel_step", "2"}, {"ray_step_px", "3"}},
};

std::string text_of(const Settings& settings) {
  std::string text;
  for (const auto& [path, value] : settings) text += path + "=" + value + " ";
  return text;
}

// The rules that do not weigh by eq. (16).
constexpr const char* kBeliefRules[] = {"log_odds", "continuous_log_odds", "visibility",
                                        "dempster_shafer"};

OccupancyParams params_with(const char* rule) {
  OccupancyParams params = scene::params(OccupancyPreset::corrected);
  apply_settings({{"update.type", rule}}, params);
  return params;
}

TEST(Integrate, EqualsTheReferenceBitByBitOnADriveWithEveryChoice) {
  const auto drive = scene::random_drive(11, 6);
  std::size_t tried = 0;
  for (const auto preset : {OccupancyPreset::literal, OccupancyPreset::corrected}) {
    std::vector<Settings> choices = single_choices(scene::params(preset));
    choices.insert(choices.end(), kFurtherChoices.begin(), kFurtherChoices.end());
    for (const Settings& choice : choices) {
      SCOPED_TRACE(text_of(choice));
      OccupancyParams params = scene::params(preset);
      apply_settings(choice, params);
      expect_equal(run(integrate, drive, params, 1), run(integrate_reference, drive, params, 1));
      ++tried;
    }
  }
  EXPECT_GE(tried, 50U);
}

TEST(Integrate, EqualsTheReferenceOnManyRandomDrives) {
  const OccupancyParams params = scene::params(OccupancyPreset::corrected);
  for (unsigned seed = 0; seed < 10; ++seed) {
    const auto drive = scene::random_drive(seed, 8);
    expect_equal(run(integrate, drive, params, 1), run(integrate_reference, drive, params, 1));
  }
}

TEST(Integrate, GivesTheSameMapForAnyNumberOfThreads) {
  const auto drive = scene::random_drive(5, 6);
  for (const auto preset :
       {OccupancyPreset::literal, OccupancyPreset::corrected, OccupancyPreset::tuned}) {
    const OccupancyParams params = scene::params(preset);
    const Result one = run(integrate, drive, params, 1);
    for (const int threads : {2, 3, 8}) expect_equal(run(integrate, drive, params, threads), one);
  }
}

TEST(Integrate, GivesTheSameMapForAnyNumberOfThreadsWhenItProjects) {
  const auto drive = scene::random_drive(7, 6);
  OccupancyParams params = scene::params(OccupancyPreset::corrected);
  params.observed_set = ObservedSet::projected;
  params.voxel_size_m = 0.07;
  const Result one = run(integrate, drive, params, 1);
  for (const int threads : {2, 3, 8}) expect_equal(run(integrate, drive, params, threads), one);
}

TEST(Integrate, GivesTheSameMapForAnyNumberOfThreadsByEveryUpdateRule) {
  const auto drive = scene::random_drive(6, 5);
  for (const char* rule : kBeliefRules) {
    SCOPED_TRACE(rule);
    const OccupancyParams params = params_with(rule);
    expect_equal(run(integrate, drive, params, 3), run(integrate, drive, params, 1));
  }
}

TEST(Integrate, EqualsTheReferenceOnManyRandomDrivesByEveryUpdateRule) {
  for (const char* rule : kBeliefRules)
    for (unsigned seed = 20; seed < 24; ++seed) {
      SCOPED_TRACE(rule);
      const auto drive = scene::random_drive(seed, 8);
      const OccupancyParams params = params_with(rule);
      expect_equal(run(integrate, drive, params, 1), run(integrate_reference, drive, params, 1));
    }
}

// The voxels along the optical axis of a camera at (0, 0, 1) that looks along +x: '.' free,
// '#' occupied, ' ' unknown.
std::string row_along_x(const VoxelMap& map) {
  std::string row;
  for (int x = 0; x < 20; ++x) {
    const Voxel voxel = map.at({x, 0, 5});
    row += !is_known(voxel) ? ' ' : voxel.state > 0.5F ? '#' : '.';
  }
  return row;
}

VoxelMap watched(const DisparityImage& image, int frames, const OccupancyParams& params) {
  VoxelMap map(params.voxel_size_m);
  for (int i = 0; i < frames; ++i)
    integrate(image, scene::camera(), scene::level_pose(), i * scene::kSecond_ns / 5, params, 1,
              map);
  return map;
}

TEST(Integrate, AWallBecomesOccupiedWithTheSpaceBeforeItFreeAndBehindItUnknown) {
  const OccupancyParams params = scene::params(OccupancyPreset::corrected);
  EXPECT_EQ(row_along_x(watched(scene::wall_at(2.1), 20, params)), "..........#         ");
}

TEST(Integrate, AFrameWithoutDisparitiesChangesNothing) {
  const OccupancyParams params = scene::params(OccupancyPreset::corrected);
  VoxelMap map(params.voxel_size_m);
  const FrameUpdate update =
      integrate(scene::empty_image(), scene::camera(), scene::level_pose(), 0, params, 1, map);
  EXPECT_EQ(map.known_voxel_count(), 0U);
  EXPECT_EQ(update.hit_voxels + update.free_voxels + update.points_used, 0);
}

TEST(Integrate, AnObstacleThatWasTakenAwayIsCleared) {
  const OccupancyParams params = scene::params(OccupancyPreset::corrected);
  VoxelMap map = watched(scene::wall_at(1.5), 20, params);
  EXPECT_EQ(row_along_x(map), ".......#            ");
  for (int i = 20; i < 60; ++i)
    integrate(scene::wall_at(2.1), scene::camera(), scene::level_pose(), i * scene::kSecond_ns / 5,
              params, 1, map);
  EXPECT_EQ(row_along_x(map), "..........#         ");
}

TEST(Integrate, AWallIsFoundAndTakenAwayByEveryUpdateRule) {
  for (const char* rule : kBeliefRules) {
    SCOPED_TRACE(rule);
    const OccupancyParams params = params_with(rule);
    VoxelMap map = watched(scene::wall_at(1.5), 20, params);
    EXPECT_EQ(row_along_x(map).substr(0, 8), ".......#");
    EXPECT_EQ(row_along_x(map).substr(9), "           ");
    for (int i = 20; i < 60; ++i)
      integrate(scene::wall_at(2.1), scene::camera(), scene::level_pose(),
                i * scene::kSecond_ns / 5, params, 1, map);
    EXPECT_EQ(row_along_x(map).substr(0, 11), "..........#");
    EXPECT_EQ(map.at({5, 0, 5}).observations, 60);
    EXPECT_EQ(map.at({5, 0, 5}).last_seen_ms, 11800U);
  }
}

TEST(Integrate, OnlyDempsterAndShaferKeepIgnorance) {
  for (const char* rule : kBeliefRules) {
    SCOPED_TRACE(rule);
    const VoxelMap map = watched(scene::wall_at(2.1), 3, params_with(rule));
    const bool keeps = rule == std::string("dempster_shafer");
    EXPECT_EQ(map.at({5, 0, 5}).ignorance > 0, keeps);
  }
}

// A wall before the middle of which stands a small square.
DisparityImage wall_and_square(double wall_m, double square_m, int side_px) {
  DisparityImage image = scene::wall_at(wall_m);
  const int first_px = (side_px - 1) / 2;  // before the pixel next to the optical axis
  image.disparity_px(cv::Rect(31 - first_px, 23 - first_px, side_px, side_px))
      .setTo(scene::camera().disparity_px(square_m));
  return image;
}

TEST(Integrate, AnOutlierMakesNoObstacleOnAContinuousRay) {
  OccupancyParams params = params_with("continuous_log_odds");
  const DisparityImage image = wall_and_square(2.1, 1.3, 1);
  EXPECT_EQ(row_along_x(watched(image, 20, params)).substr(0, 11), "..........#");
  params.union_rule = MaxUnion{};
  EXPECT_EQ(row_along_x(watched(image, 20, params))[6], '#');
}

TEST(Integrate, ASmallObstacleIsNotErasedByTheContinuousRaysThatPassIt) {
  const OccupancyParams params = params_with("continuous_log_odds");
  EXPECT_EQ(row_along_x(watched(wall_and_square(2.1, 1.3, 4), 20, params)).substr(0, 7), "......#");
}

TEST(Integrate, AContinuousRayMarksTheCoarseVoxelThatHoldsTheSurface) {
  OccupancyParams params = params_with("continuous_log_odds");
  params.voxel_size_m = 0.5;
  params.max_depth_m = 6.0;
  for (const double depth_m : {1.05, 1.25, 1.4}) {
    const VoxelMap map = watched(scene::wall_at(depth_m), 10, params);
    EXPECT_LT(map.at({1, 0, 2}).state, 0.5F) << depth_m;
    EXPECT_GT(map.at({2, 0, 2}).state, 0.5F) << depth_m;
  }
  EXPECT_FALSE(is_known(watched(scene::wall_at(1.05), 10, params).at({3, 0, 2})));
}

TEST(Integrate, FarMeasurementsOnlyClearSpaceUpToTheLimit) {
  OccupancyParams params = scene::params(OccupancyPreset::corrected);
  params.max_depth_m = 2.0;
  params.max_clearing_m = 1.5;
  EXPECT_EQ(row_along_x(watched(scene::wall_at(3.1), 20, params)), "........            ");
}

TEST(Integrate, UncertainMeasurementsMarkNoSurface) {
  OccupancyParams params = scene::params(OccupancyPreset::corrected);
  params.max_sigma_half_voxels = 0.1;
  VoxelMap map(params.voxel_size_m);
  const FrameUpdate update =
      integrate(scene::wall_at(2.1), scene::camera(), scene::level_pose(), 0, params, 1, map);
  EXPECT_EQ(update.hit_voxels, 0);
  EXPECT_GT(update.free_voxels, 0);
}

TEST(Integrate, PointsBelowTheFloorSayNothing) {
  OccupancyParams params = scene::params(OccupancyPreset::corrected);
  DisparityImage image = scene::wall_at(3.0);
  image.disparity_px.rowRange(0, 40).setTo(0);  // what is left lies at heights below 0.03 m
  params.min_height_m = 0.2;
  VoxelMap map(params.voxel_size_m);
  integrate(image, scene::camera(), scene::level_pose(), 0, params, 1, map);
  EXPECT_EQ(map.known_voxel_count(), 0U);
}

TEST(Integrate, KeepsWithinTheHeightLimits) {
  const OccupancyParams params = scene::params(OccupancyPreset::corrected);
  const VoxelMap map = watched(scene::wall_at(3.0), 1, params);
  ASSERT_TRUE(map.bounds().has_value());
  EXPECT_GE((map.bounds()->min.z() + 1) * params.voxel_size_m, params.min_height_m);
  EXPECT_LE((map.bounds()->max.z() - 1) * params.voxel_size_m, params.max_height_m);
}

TEST(Integrate, TheWorldMovesWithTheCamera) {
  const OccupancyParams params = scene::params(OccupancyPreset::corrected);
  const Eigen::Vector3i moved_voxels(30, -7, 0);
  const auto hits_from = [&](const Eigen::Vector3i& shift) {
    const Eigen::Vector3d position =
        Eigen::Vector3d(0.1, 0.1, 0.9) + shift.cast<double>() * params.voxel_size_m;
    VoxelMap map(params.voxel_size_m);
    auto hits = integrate(scene::wall_at(2.1), scene::camera(), scene::level_pose(0.0, position), 0,
                          params, 1, map)
                    .hits;
    for (Eigen::Vector3i& hit : hits) hit -= shift;
    return hits;
  };
  EXPECT_FALSE(hits_from({0, 0, 0}).empty());
  EXPECT_EQ(hits_from(moved_voxels), hits_from({0, 0, 0}));
}

TEST(Integrate, CountsObservationsAndRemembersTheTime) {
  const OccupancyParams params = scene::params(OccupancyPreset::corrected);
  const VoxelMap map = watched(scene::wall_at(2.1), 7, params);
  EXPECT_EQ(map.at({5, 0, 5}).observations, 7);
  EXPECT_EQ(map.at({5, 0, 5}).last_seen_ms, 1200U);
  EXPECT_EQ(map.frames_integrated, 7U);
}

std::string complaint(const std::function<void()>& body) {
  try {
    body();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Integrate, RefusesFramesThatDoNotFitTheMapAndLeavesItAlone) {
  const OccupancyParams params = scene::params(OccupancyPreset::corrected);
  VoxelMap map = watched(scene::wall_at(2.1), 1, params), coarse(0.5);
  const auto add = [&](VoxelMap& m, const Eigen::Vector3d& position, std::int64_t stamp_ns) {
    return complaint([&] {
      integrate(scene::wall_at(2.0), scene::camera(), scene::level_pose(0, position), stamp_ns,
                params, 1, m);
    });
  };
  EXPECT_EQ(add(coarse, {0, 0, 1}, 0),
            "voxel size of the map is 0.5 m, of the configuration 0.2 m");
  EXPECT_THAT(add(map, {0, 0, 1}, -1), testing::HasSubstr("frame at -1 ns does not lie within"));
  EXPECT_THAT(add(map, {0, 0, 1}, 5'000'000 * scene::kSecond_ns), testing::HasSubstr("49 days"));
  EXPECT_THAT(add(map, {1e8, 0, 1}, 0), testing::HasSubstr("is beyond the map's limit"));
  EXPECT_EQ(map.frames_integrated, 1U);
  EXPECT_FALSE(coarse.epoch_ns.has_value());
}

TEST(Integrate, CallsWithUnfittingArgumentsAreProgrammingErrors) {
  const OccupancyParams params = scene::params(OccupancyPreset::corrected);
  VoxelMap map(params.voxel_size_m);
  const DisparityImage small{.disparity_px = cv::Mat1f(4, 4, 1.0F),
                             .sigma_px = cv::Mat1f(4, 4, 1.0F)};
  EXPECT_THROW(integrate(small, scene::camera(), SE3{}, 0, params, 1, map), std::logic_error);
  SE3 broken;
  broken.translation.x() = std::nan("");
  EXPECT_THROW(integrate(scene::wall_at(2.0), scene::camera(), broken, 0, params, 1, map),
               std::logic_error);
}

}  // namespace
}  // namespace stereovox
