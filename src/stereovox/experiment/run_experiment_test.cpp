#include "stereovox/experiment/run_experiment.h"

#include <gmock/gmock.h>

#include <fstream>

#include "stereovox/core/error.h"
#include "stereovox/io/temporary_folder.h"
#include "stereovox/simulation/room_for_test.h"

namespace stereovox {
namespace {

using testing::HasSubstr;

// One room, one seed, small images: the whole experiment in a few seconds.
constexpr const char* kExperiment = R"(
name: small
development_world: none
worlds: [{file: room.yaml}]
simulation:
  shift_m: 0.25
  rig: {width_px: 240, height_px: 180, focal_px: 200}
pipeline:
  matcher: {disparity_range_px: 48}
groups:
  - title: All
    cell_sizes_m: [0.25]
    poses: [truth, estimated]
    seeds: [1]
    methods:
      - {name: tuned, kind: stereovox, settings: {occupancy.preset: tuned, navmap.preset: tuned}}
      - {name: printed, kind: stereovox, settings: {occupancy.preset: literal}}
      - {name: Matthies, kind: matthies_elfes_1988}
      - {name: Thrun, kind: thrun_2001}
      - {name: tree, kind: octomap, settings: {pixel_step: 4}}
)";

class Experiment : public testing::Test {
 protected:
  Experiment() {
    std::ofstream(folder_ / "room.yaml") << room_text();
    write(kExperiment);
  }
  void write(const std::string& text) { std::ofstream(folder_ / "e.yaml") << text; }

  ExperimentResult run(const std::string& output, int threads = 1) {
    said_.clear();
    return run_experiment(
        read_experiment(folder_ / "e.yaml"), folder_ / output, folder_ / "cache", "build", threads,
        {[&](const std::string& text) { said_ += text + "\n"; }, [] { return false; }});
  }

  std::string error_of(const std::string& text) {
    write(text);
    try {
      read_experiment(folder_ / "e.yaml");
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }

  static std::string replaced(const std::string& from, const std::string& to) {
    std::string text = kExperiment;
    return text.replace(text.find(from), from.size(), to);
  }

  const TemporaryFolder temporary_;
  const std::filesystem::path folder_ = temporary_.path();
  std::string said_;
};

TEST_F(Experiment, MapsScoresAndReportsEveryMethod) {
  const ExperimentResult result = run("out");
  EXPECT_FALSE(result.was_stopped);
  ASSERT_EQ(result.rows.size(), 10U);  // 5 methods, 2 pose sources
  for (const ResultRow& row : result.rows) {
    EXPECT_TRUE(row.values.contains("ternary_correlation")) << row.of.method;
    EXPECT_GT(row.values.at("coverage"), 0.3) << row.of.method;
  }
  // The system sees the box and the walls.
  EXPECT_GT(result.rows[0].values.at("ternary_correlation"), 0.3);
  EXPECT_GT(result.rows[0].values.at("voxels_precision_1"), 0.6);
  for (const char* name :
       {"report.md", "results.csv", "experiment.yaml", "parameters.txt",
        "figures/room_s1_ideal_025cm_fig8.png", "figures/room_s1_truth_025cm_All_maps_fig9.png",
        "maps/room_s1_truth_025cm_All_Matthies.yaml",
        "maps/room_s1_truth_025cm_All_tuned_voxels.png"})
    EXPECT_TRUE(std::filesystem::exists(folder_ / "out" / name)) << name;
}

TEST_F(Experiment, ThatWasFinishedIsNotDoneAgain) {
  run("out");
  EXPECT_THAT(said_, HasSubstr("rendered"));
  const ExperimentResult again = run("out");
  EXPECT_EQ(said_, "[1/1] room, seed 1: found the results of an earlier run\n");
  EXPECT_EQ(again.rows.size(), 10U);
}

TEST_F(Experiment, GoesOnWhereItWasStoppedWhileRendering) {
  const ExperimentConfig config = read_experiment(folder_ / "e.yaml");
  int asked = 0;
  const auto stopped = run_experiment(config, folder_ / "out", folder_ / "cache", "build", 1,
                                      {[](const std::string&) {}, [&] { return ++asked > 2; }});
  EXPECT_TRUE(stopped.was_stopped);
  EXPECT_TRUE(stopped.rows.empty());
  const auto resumed = run("out").rows;
  const auto whole = run_experiment(config, folder_ / "whole", folder_ / "other_cache", "build", 1,
                                    {[](const std::string&) {}, [] { return false; }})
                         .rows;
  ASSERT_EQ(resumed.size(), whole.size());
  for (std::size_t i = 0; i < whole.size(); ++i)
    EXPECT_EQ(resumed[i].values.at("known_fraction"), whole[i].values.at("known_fraction"));
}

TEST_F(Experiment, UsesTheRenderedDriveForOtherMethods) {
  run("out");
  write(replaced("name: printed", "name: as printed"));
  run("other");
  EXPECT_THAT(said_, testing::Not(HasSubstr("rendered")));
  EXPECT_THAT(said_, testing::Not(HasSubstr("matched")));
  EXPECT_THAT(said_, HasSubstr("mapped with truth poses by 5 methods"));
}

TEST_F(Experiment, GivesTheSameForAnyNumberOfThreads) {
  const auto one = run("one", 1).rows, three = run("three", 3).rows;
  ASSERT_EQ(one.size(), three.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    auto a = one[i].values, b = three[i].values;
    a.erase("map_ms_per_frame");
    b.erase("map_ms_per_frame");
    EXPECT_EQ(one[i].of, three[i].of);
    EXPECT_EQ(a, b) << one[i].of.method;
  }
}

TEST_F(Experiment, MistakesInTheFileAreNamed) {
  EXPECT_THAT(error_of(replaced("kind: octomap", "kind: octomapp")),
              HasSubstr("there is no kind 'octomapp', did you mean 'octomap'?"));
  EXPECT_THAT(error_of(replaced("pixel_step: 4", "pixel_steps: 4")),
              HasSubstr("unknown parameter 'pixel_steps'"));
  EXPECT_THAT(error_of(replaced("truth, estimated", "truth, guessed")),
              HasSubstr("'poses' are truth or estimated, not 'guessed'"));
  EXPECT_THAT(error_of(replaced("name: Thrun", "name: Matthies")),
              HasSubstr("two methods are named 'Matthies'"));
  EXPECT_THAT(error_of(replaced("file: room.yaml", "file: room.yaml, drive: other")),
              HasSubstr("has no drive 'other', only main"));
  EXPECT_THAT(error_of(replaced("file: room.yaml", "file: none.yaml")), HasSubstr("none.yaml"));
  EXPECT_THAT(error_of(replaced("shift_m: 0.25", "shift_m: -1")), HasSubstr("shift_m"));
}

TEST(ExperimentFile, ThatIsShippedIsValid) {
  const ExperimentConfig config = read_experiment(STEREOVOX_SOURCE_DIR "/experiments/table1.yaml");
  EXPECT_GE(config.worlds.size(), 3U);
  EXPECT_GE(config.seeds().size(), 3U);
  for (const ExperimentWorld& world : config.worlds)
    EXPECT_NE(world.name, config.development_world);
}

TEST_F(Experiment, ADriveThatHitsSomethingIsRefusedBeforeAnythingIsRendered) {
  std::ofstream(folder_ / "blocked.yaml")
      << room_text().replace(room_text().find("[2.5, 2]"), 8, "[4.5, 2]");
  write(
      replaced("worlds: [{file: room.yaml}]", "worlds: [{file: room.yaml}, {file: blocked.yaml}]"));
  try {
    run("out");
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("blocked.yaml: drive 'main' comes within"));
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "cache"));
}

}  // namespace
}  // namespace stereovox
