// `stereovox simulate` as a user meets it.
#include <gtest/gtest.h>

#include <fstream>

#include "program.h"
#include "stereovox/navmap/read_map_server.h"

namespace stereovox {
namespace {

namespace fs = std::filesystem;

constexpr const char* kStudio = R"(
name: studio
room: {size_m: [4, 3], height_m: 2.5, wall_thickness_m: 0.2, floor: parquet, ceiling: ceiling, wall: plaster}
lights: {ambient: 0.35, power: 1.8, spacing_m: [2, 2]}
things:
  - {kind: box, at: [3, 2], size_m: [1, 1, 1]}
drives:
  main: {speed_m_s: 0.5, rate_hz: 2, waypoints: [[0.8, 0.8], [1.8, 0.8]]}
)";

ProgramResult simulate_studio(const fs::path& folder, const std::string& options = "") {
  std::ofstream(folder / "studio.yaml") << kStudio;
  return run_program("simulate " + quoted(folder / "studio.yaml") + " -q -o " +
                     quoted(folder / "drive") + " --set jitter_m=0 --set rig.width_px=64" +
                     " --set rig.height_px=48 --set rig.focal_px=50 " + options);
}

TEST(Simulate, WritesADriveThatCheckAccepts) {
  const fs::path folder = empty_folder("simulate");
  const ProgramResult result = simulate_studio(folder);
  ASSERT_EQ(result.exit_code, 0) << result.output;
  for (const char* name : {"calib.yaml", "times.txt", "poses.txt", "doorways.yaml"})
    EXPECT_TRUE(fs::exists(folder / "drive" / name)) << name;
  const ProgramResult check = run_program("check " + quoted(folder / "drive"));
  EXPECT_EQ(check.exit_code, 0) << check.output;
}

TEST(Simulate, AnEarlierDataSetIsReplacedOnlyOnRequestAndWhole) {
  const fs::path folder = empty_folder("simulate_twice"),
                 more = folder / "drive" / "left" / "x.png";
  fs::create_directories(more.parent_path());
  std::ofstream(more) << "of another data set";
  const ProgramResult refused = simulate_studio(folder);
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.output.find("holds a data set; give --overwrite"), std::string::npos);
  EXPECT_TRUE(fs::exists(more));
  const ProgramResult replaced = simulate_studio(folder, "--overwrite");
  EXPECT_EQ(replaced.exit_code, 0) << replaced.output;
  EXPECT_FALSE(fs::exists(more));
}

TEST(Simulate, SolidsOfTheIdealMapAreFilled) {
  const fs::path folder = empty_folder("simulate_ideal");
  const ProgramResult result = simulate_studio(folder, "--cell-size 0.25");
  ASSERT_EQ(result.exit_code, 0) << result.output;
  const OccupancyGrid2D map = read_map_server(folder / "drive" / "ideal_025cm.yaml").grid;
  const auto label_at = [&](double x_m, double y_m) {
    return map.label_at(index_of(map.geometry, {x_m, y_m}));
  };
  EXPECT_EQ(label_at(1.1, 1.1), CellLabel::free);
  EXPECT_EQ(label_at(2.6, 2.1), CellLabel::occupied);  // the edge of the box
  EXPECT_EQ(label_at(3.1, 2.1), CellLabel::occupied);  // and its middle
}

}  // namespace
}  // namespace stereovox
