// The whole line on the embedded drive, through the program and through the library.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <nlohmann/json.hpp>

#include "program.h"
#include "stereovox/evaluation/trajectory_score.h"
#include "stereovox/io/trajectory_file.h"
#include "stereovox/navmap/read_map_server.h"

namespace stereovox {
namespace {

namespace fs = std::filesystem;

const fs::path kDemo = fs::path(STEREOVOX_SOURCE_DIR) / "data" / "office_demo";

nlohmann::json json_of(const fs::path& path) { return nlohmann::json::parse(text_of(path)); }

// Cells of `map` with `label` that the true plan knows, and how many of them are right there within
// a cell.
struct Agreement {
  int known = 0, right = 0;
  double share() const { return known == 0 ? 0.0 : static_cast<double>(right) / known; }
};

Agreement agreement(const OccupancyGrid2D& map, const OccupancyGrid2D& truth, CellLabel label) {
  Agreement found;
  const auto label_in = [](const OccupancyGrid2D& grid, const Eigen::Vector2i& cell) {
    if (!grid.geometry.contains(cell)) return CellLabel::unknown;
    return grid.labels[static_cast<std::size_t>(cell.y() * grid.geometry.width + cell.x())];
  };
  for (int y = 0; y < map.geometry.height; ++y)
    for (int x = 0; x < map.geometry.width; ++x) {
      if (label_in(map, {x, y}) != label) continue;
      const Eigen::Vector2i there = index_of(truth.geometry, center_of(map.geometry, {x, y}));
      if (label_in(truth, there) == CellLabel::unknown) continue;
      ++found.known;
      bool is_right = false;
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx)
          is_right |= label_in(truth, there + Eigen::Vector2i(dx, dy)) == label;
      found.right += is_right ? 1 : 0;
    }
  return found;
}

TEST(EndToEnd, TheDemoDriveIsTrackedAndMapped) {
  const fs::path out = empty_folder("out");
  const ProgramResult result = run_program("run " + quoted(kDemo) + " -o " + quoted(out));
  ASSERT_EQ(result.exit_code, 0) << result.output;
  for (const char* name : {"map.svx", "nav.pgm", "nav.yaml", "nav.png", "trajectory.tum",
                           "trajectory_kitti.txt", "report.json", "config.yaml"})
    EXPECT_GT(fs::file_size(out / name), 0U) << name;
  const nlohmann::json report = json_of(out / "report.json");
  EXPECT_EQ(report["frames"], 60);
  EXPECT_EQ(report["tracked"], 60);
  for (const char* stage : {"rectify", "disparity", "odometry", "occupancy", "navmap"})
    EXPECT_TRUE(report["stages"][stage].contains("p95_ms")) << stage;

  TrajectoryScoreParams origin;
  origin.alignment = Alignment::origin;
  const TrajectoryScore score =
      score_trajectory(read_tum(kDemo / "poses.txt"), read_tum(out / "trajectory.tum"), origin);
  EXPECT_EQ(score.matched, 60);
  EXPECT_LT(score.end_drift_percent, 1.5);
}

TEST(EndToEnd, TheMapOfTheDemoDriveAgreesWithTheFloorPlan) {
  const fs::path out = empty_folder("out");
  const ProgramResult result =
      run_program("run " + quoted(kDemo) + " -q --poses truth -o " + quoted(out));
  ASSERT_EQ(result.exit_code, 0) << result.output;
  const OccupancyGrid2D map = read_map_server(out / "nav.yaml").grid;
  const OccupancyGrid2D truth = read_map_server(kDemo / "ideal_005cm.yaml").grid;
  const Agreement free = agreement(map, truth, CellLabel::free);
  const Agreement occupied = agreement(map, truth, CellLabel::occupied);
  EXPECT_GT(free.known, 8000);
  EXPECT_GT(free.share(), 0.97);
  EXPECT_GT(occupied.known, 500);
  EXPECT_GT(occupied.share(), 0.75);
}

TEST(EndToEnd, MapsAreTheSameBytesForAnyNumberOfThreads) {
  const fs::path data = office_extract("data", 12);
  const fs::path out = empty_folder("out");
  for (const char* threads : {"1", "2", "3", "8"}) {
    const ProgramResult result = run_program("run " + quoted(data) + " -q --threads " + threads +
                                             " -o " + quoted(out / threads));
    ASSERT_EQ(result.exit_code, 0) << result.output;
    for (const char* name : {"map.svx", "nav.pgm", "nav.png", "trajectory.tum"})
      EXPECT_EQ(text_of(out / threads / name), text_of(out / "1" / name)) << threads << " threads";
  }
}

TEST(EndToEnd, TheNavigationMapCanBeMadeAgainFromTheVoxels) {
  const fs::path data = office_extract("data", 12);
  const fs::path out = empty_folder("out");
  ASSERT_EQ(run_program("run " + quoted(data) + " -q -o " + quoted(out)).exit_code, 0);
  const ProgramResult again =
      run_program("navmap " + quoted(out / "map.svx") + " -o " + quoted(out / "again.yaml"));
  EXPECT_EQ(again.exit_code, 0) << again.output;
  EXPECT_EQ(text_of(out / "again.pgm"), text_of(out / "nav.pgm"));
}

TEST(EndToEnd, TheConfigurationOfARunRepeatsIt) {
  const fs::path data = office_extract("data", 8);
  const fs::path out = empty_folder("out");
  ASSERT_EQ(run_program("run " + quoted(data) + " -q --set occupancy.voxel_size_m=0.1 -o " +
                        quoted(out / "first"))
                .exit_code,
            0);
  ASSERT_EQ(run_program("run " + quoted(data) + " -q --config " +
                        quoted(out / "first" / "config.yaml") + " -o " + quoted(out / "second"))
                .exit_code,
            0);
  for (const char* name : {"map.svx", "nav.yaml", "nav.pgm", "config.yaml"})
    EXPECT_EQ(text_of(out / "second" / name), text_of(out / "first" / name)) << name;
}

TEST(EndToEnd, LiteralPresetRunsAsPrinted) {
  const fs::path data = office_extract("data", 8);
  const fs::path out = empty_folder("out");
  const ProgramResult result =
      run_program("run " + quoted(data) +
                  " -q --preset literal --set occupancy.voxel_size_m=0.25 -o " + quoted(out));
  EXPECT_EQ(result.exit_code, 0) << result.output;
}

// Interrupted when it says that it has begun, however slow the machine is.
TEST(EndToEnd, CtrlCSavesWhatThereIsAndExitsWith130) {
  const fs::path out = empty_folder("out");
  std::array<int, 2> talk{};
  ASSERT_EQ(pipe(talk.data()), 0);
  const pid_t child = fork();
  if (child == 0) {
    dup2(talk[1], STDOUT_FILENO);
    dup2(talk[1], STDERR_FILENO);
    close(talk[0]);
    close(talk[1]);
    execl(STEREOVOX_PROGRAM, "stereovox", "run", kDemo.c_str(), "--json-progress", "--threads", "1",
          "-o", out.c_str(), nullptr);
    _exit(127);
  }
  close(talk[1]);
  char letter = 0;
  while (read(talk[0], &letter, 1) == 1 && letter != '\n') continue;
  kill(child, SIGINT);
  while (read(talk[0], &letter, 1) == 1) continue;
  close(talk[0]);
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 130);
  const nlohmann::json report = json_of(out / "report.json");
  EXPECT_TRUE(report["stopped_early"]);
  EXPECT_LT(report["frames"], 60);
  EXPECT_TRUE(fs::exists(out / "map.svx"));
}

TEST(EndToEnd, DisparityWritesWhatScoreReads) {
  const fs::path out = empty_folder("out");
  const std::string left = quoted(kDemo / "left" / "000010.png");
  const std::string right = quoted(kDemo / "right" / "000010.png");
  for (const char* name : {"d.pfm", "d.png"}) {
    const ProgramResult made =
        run_program("disparity " + left + " " + right + " -o " + quoted(out / name) +
                    " --picture " + quoted(out / "picture.png"));
    EXPECT_EQ(made.exit_code, 0) << made.output;
  }
  const ProgramResult score =
      run_program("score disparity " + quoted(out / "d.pfm") + " " + quoted(out / "d.png") +
                  " --json " + quoted(out / "score.json"));
  EXPECT_EQ(score.exit_code, 0) << score.output;
  EXPECT_LT(json_of(out / "score.json")["mae_px"], 0.01);
  EXPECT_TRUE(fs::exists(out / "picture.png"));
}

TEST(EndToEnd, DisparityWritesItsConfidence) {
  const fs::path out = empty_folder("out");
  const std::string made = "disparity " + quoted(kDemo / "left" / "000010.png") + " " +
                           quoted(kDemo / "right" / "000010.png") + " -o " + quoted(out / "d.pfm") +
                           " --confidence " + quoted(out / "c.pfm");
  const ProgramResult with = run_program(made + " --set matcher.type=census_sgm");
  EXPECT_EQ(with.exit_code, 0) << with.output;
  EXPECT_EQ(fs::file_size(out / "c.pfm"), fs::file_size(out / "d.pfm"));
  const ProgramResult without = run_program(made + " --set matcher.type=sgbm");
  EXPECT_EQ(without.exit_code, 2);
  EXPECT_THAT(without.output, testing::HasSubstr("this matcher has none"));
  const ProgramResult score = run_program("score disparity " + quoted(out / "d.pfm") + " " +
                                          quoted(out / "d.pfm") + " --without-occlusions");
  EXPECT_EQ(score.exit_code, 0) << score.output;
  EXPECT_THAT(score.output, testing::HasSubstr("100.00 % of them with a disparity"));
}

TEST(EndToEnd, OdometryAndScoreTrajectoryWorkTogether) {
  const fs::path data = office_extract("data", 12);
  const fs::path out = empty_folder("out");
  const ProgramResult tracked =
      run_program("odometry " + quoted(data) + " -o " + quoted(out / "t.tum"));
  EXPECT_EQ(tracked.exit_code, 0) << tracked.output;
  EXPECT_THAT(tracked.output, testing::HasSubstr("12 poses"));
  const ProgramResult score =
      run_program("score trajectory " + quoted(data / "poses.txt") + " " + quoted(out / "t.tum") +
                  " --json " + quoted(out / "score.json"));
  EXPECT_EQ(score.exit_code, 0) << score.output;
  EXPECT_LT(json_of(out / "score.json")["ate_m"]["rmse"], 0.05);
}

TEST(EndToEnd, InfoAndCheckTellAboutEverythingARunMakes) {
  const fs::path data = office_extract("data", 6);
  const fs::path out = empty_folder("out");
  ASSERT_EQ(run_program("run " + quoted(data) + " -q -o " + quoted(out)).exit_code, 0);
  for (const fs::path& what : {data, out, out / "map.svx", out / "nav.yaml"}) {
    const ProgramResult info = run_program("info " + quoted(what));
    EXPECT_EQ(info.exit_code, 0) << info.output;
    EXPECT_GT(info.output.size(), 50U);
  }
  for (const char* map : {"map.svx", "nav.yaml", "."}) {
    const fs::path picture = out / (std::string("picture of ") + map + ".png");
    EXPECT_EQ(run_program("info " + quoted(out / map) + " --picture " + quoted(picture)).exit_code,
              0);
    EXPECT_GT(fs::file_size(picture), 1000U) << map;
  }
  EXPECT_EQ(run_program("info " + quoted(data) + " --picture " + quoted(out / "no.png")).exit_code,
            2);
  for (const fs::path& what : {data, out / "map.svx", out / "nav.yaml", data / "calib.yaml"}) {
    const ProgramResult check = run_program("check " + quoted(what));
    EXPECT_EQ(check.exit_code, 0) << check.output;
  }
}

}  // namespace
}  // namespace stereovox
