// `stereovox score map` and `score voxels` as a user meets them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "program.h"
#include "stereovox/io/image_file.h"
#include "stereovox/navmap/drawn_map_for_test.h"
#include "stereovox/navmap/write_map_server.h"
#include "stereovox/occupancy/voxel_map_file.h"

namespace stereovox {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const Drawing kPlan = {"##########",  //
                       "#........#",  //
                       "#........#",  //
                       "#........#",  //
                       "##########"};

std::string write_drawn(const fs::path& path, const Drawing& drawing, double cell_size_m = 0.25,
                        const Eigen::Vector2d& origin_m = {0, 0}) {
  write_map_server(path, drawn_grid(drawing, cell_size_m, origin_m));
  return "'" + path.string() + "' ";
}

nlohmann::json json_of(const fs::path& path) { return nlohmann::json::parse(text_of(path)); }

TEST(ScoreMap, OfAMapWithItselfIsPerfectInEveryFile) {
  const fs::path folder = empty_folder("score_map");
  const std::string map = write_drawn(folder / "plan.yaml", kPlan);
  const ProgramResult result = run_program(
      "score map " + map + map + "--start 0.5,0.5 --json '" + (folder / "s.json").string() +
      "' --csv '" + (folder / "s.csv").string() + "' --plot '" + (folder / "s.png").string() + "'");
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr("correlation with T"));
  EXPECT_DOUBLE_EQ(json_of(folder / "s.json").at("ternary_correlation").get<double>(), 1.0);
  EXPECT_THAT(text_of(folder / "s.csv"), HasSubstr("paths_fp_percent"));
  EXPECT_FALSE(read_image(folder / "s.png").empty());
}

TEST(ScoreMap, OtherCellSizesNeedResampling) {
  const fs::path folder = empty_folder("score_map");
  Drawing fine;
  for (const std::string& row : kPlan) {
    std::string wide;
    for (const char c : row) wide += {c, c};
    fine.insert(fine.end(), 2, wide);
  }
  const std::string maps =
      write_drawn(folder / "plan.yaml", kPlan) + write_drawn(folder / "fine.yaml", fine, 0.125);
  const ProgramResult refused = run_program("score map " + maps);
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_THAT(refused.output, HasSubstr("--resample brings it to those"));
  const ProgramResult result =
      run_program("score map " + maps + "--resample --json '" + (folder / "s.json").string() + "'");
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_DOUBLE_EQ(json_of(folder / "s.json").at("iou_occupied").get<double>(), 1.0);
}

TEST(ScoreMap, AlignsAMapThatIsShifted) {
  const fs::path folder = empty_folder("score_map");
  const std::string maps = write_drawn(folder / "plan.yaml", kPlan) +
                           write_drawn(folder / "moved.yaml", kPlan, 0.25, {0.5, -0.25});
  const ProgramResult result = run_program("score map " + maps + "--align");
  EXPECT_THAT(result.output, HasSubstr("aligned: moved by (-0.5, 0.25) m"));
}

TEST(ScoreMap, TestsTheDoorwaysOfAFile) {
  const fs::path folder = empty_folder("score_map");
  Drawing open = kPlan, closed = kPlan;
  for (Drawing* plan : {&open, &closed})
    plan->insert(plan->begin(), kPlan.begin(), kPlan.end() - 1);
  open[4] = "###....###";
  std::ofstream(folder / "doors.yaml")
      << "doorways:\n  - {name: middle, a: [0.75, 1.125], b: [1.75, 1.125]}\n";
  const ProgramResult result =
      run_program("score map " + write_drawn(folder / "open.yaml", open) +
                  write_drawn(folder / "closed.yaml", closed) + "--robot-radius 0.2 --doorways '" +
                  (folder / "doors.yaml").string() + "'");
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr("closed door: middle"));
}

TEST(ScoreMap, AStartInAWallIsRefused) {
  const fs::path folder = empty_folder("score_map");
  const std::string map = write_drawn(folder / "plan.yaml", kPlan);
  const ProgramResult result = run_program("score map " + map + map + "--start 0.1,0.1");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.output, HasSubstr("the start (0.1, 0.1) m is on no free cell"));
}

TEST(ScoreVoxels, ComparesTwoVoxelMaps) {
  const fs::path folder = empty_folder("score_voxels");
  const fs::path file = folder / "map.svx";
  write_voxel_map(file, drawn_voxels(kPlan));
  const std::string name = "'" + file.string() + "' ";
  const ProgramResult result =
      run_program("score voxels " + name + name + "--json '" + (folder / "s.json").string() + "'");
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_DOUBLE_EQ(json_of(folder / "s.json").at("f1").get<double>(), 1.0);
}

}  // namespace
}  // namespace stereovox
