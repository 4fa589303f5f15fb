// A run with a limit to its memory, and damaged and merged maps, as a user meets them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <thread>

#include "program.h"

namespace stereovox {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

TEST(MemoryLimit, ChangesNoByteOfTheResults) {
  const fs::path data = office_extract("data", 10), out = empty_folder("out");
  ASSERT_EQ(run_program("run " + quoted(data) + " -q -o " + quoted(out / "all")).exit_code, 0);
  for (const char* threads : {"1", "3"}) {
    const fs::path limited = out / threads;
    const ProgramResult result = run_program("run " + quoted(data) + " -q --memory-limit 500K -o " +
                                             quoted(limited) + " --threads " + threads);
    ASSERT_EQ(result.exit_code, 0) << result.output;
    for (const char* name : {"map.svx", "nav.pgm", "nav.png", "trajectory.tum"})
      EXPECT_EQ(text_of(limited / name), text_of(out / "all" / name)) << name;
  }
}

TEST(MemoryLimit, NonsenseIsRefused) {
  const ProgramResult result = run_program("run data -o out --memory-limit plenty");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.output, HasSubstr("--memory-limit"));
}

TEST(MemoryLimit, AStoreThatCannotGrowIsOneLineAndTheMapIsSaved) {
  const fs::path data = office_extract("data", 10), out = empty_folder("out");
  const std::string run = "run " + quoted(data) + " -q -o ";
  ASSERT_EQ(run_program(run + quoted(out / "all")).exit_code, 0);
  // A limit to the size of files stands for a full disk: the map fits, the store, which has whole
  // pages, does not.
  constexpr std::uintmax_t kBlockBytes = 512;
  const std::uintmax_t blocks = fs::file_size(out / "all" / "map.svx") / kBlockBytes + 1;
  const ProgramResult result = run_under("trap '' XFSZ; ulimit -f " + std::to_string(blocks),
                                         run + quoted(out / "limited") + " --memory-limit 1K");
  EXPECT_EQ(result.exit_code, 5) << result.output;
  EXPECT_THAT(result.output, HasSubstr("cannot be written (File too large); what was mapped"));
  EXPECT_EQ(std::ranges::count(result.output, '\n'), 1) << result.output;
  EXPECT_EQ(run_program("check " + quoted(out / "limited" / "map.svx")).exit_code, 0);
  EXPECT_THAT(text_of(out / "limited" / "report.json"), HasSubstr("\"stopped_early\": true"));
}

TEST(MemoryLimit, AKilledRunLeavesNoFiles) {
  const fs::path data = office_extract("data", 40);
  for (const int wait_ms : {100, 300, 600, 900}) {
    const fs::path out = empty_folder("out");
    const pid_t child = fork();
    if (child == 0) {
      execl(STEREOVOX_PROGRAM, "stereovox", "run", data.c_str(), "-q", "--memory-limit", "100K",
            "-o", out.c_str(), nullptr);
      _exit(127);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(wait_ms));
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    if (!WIFSIGNALED(status)) continue;  // it ended before
    for (const auto& entry : fs::directory_iterator(out))
      ADD_FAILURE() << "left behind: " << entry.path();
  }
}

TEST(Merge, AMapWithItselfKnowsTheSamePlaces) {
  const fs::path data = office_extract("data", 3), out = empty_folder("out");
  ASSERT_EQ(run_program("run " + quoted(data) + " -q -o " + quoted(out)).exit_code, 0);
  const std::string map = quoted(out / "map.svx");
  const ProgramResult merged =
      run_program("merge " + map + " " + map + " -o " + quoted(out / "both.svx"));
  ASSERT_EQ(merged.exit_code, 0) << merged.output;
  const auto voxels = [](const std::string& text) {
    return text.substr(0, text.find(" voxels")).substr(text.rfind(' ', text.find(" voxels") - 1));
  };
  EXPECT_EQ(voxels(merged.output), voxels(run_program("check " + map).output));
  const ProgramResult moved =
      run_program("merge " + map + " " + map + " --at 100,0,0,90 -o " + quoted(out / "moved.svx"));
  EXPECT_EQ(moved.exit_code, 0) << moved.output;
  EXPECT_NE(voxels(moved.output), voxels(merged.output));
  const ProgramResult lost =
      run_program("merge " + map + " " + map + " --at 1e12,0,0,0 -o " + quoted(out / "lost.svx"));
  EXPECT_EQ(lost.exit_code, 3) << lost.output;
  EXPECT_THAT(lost.output, HasSubstr("beyond the map's limit"));
}

TEST(Merge, TheNavigationMapOfTheWholeIsThatOfItsParts) {
  const fs::path data = office_extract("data", 3), out = empty_folder("out");
  ASSERT_EQ(run_program("run " + quoted(data) + " -q -o " + quoted(out)).exit_code, 0);
  const std::string map = quoted(out / "map.svx");
  ASSERT_EQ(run_program("merge " + map + " " + map + " -o " + quoted(out / "both.svx")).exit_code,
            0);
  const auto counts = [&](const std::string& of) {
    const std::string text =
        run_program("navmap " + of + " --min-observations 1 -o " + quoted(out / "n.yaml")).output;
    return text.substr(text.find(" m: "), text.find('\n') - text.find(" m: "));
  };
  EXPECT_EQ(counts(quoted(out / "both.svx")), counts(map));
}

TEST(Merge, MapsOfDifferentVoxelSizesAreRefused) {
  const fs::path data = office_extract("data", 3), out = empty_folder("out");
  for (const char* size : {"0.1", "0.2"})
    ASSERT_EQ(run_program("run " + quoted(data) + " -q --set occupancy.voxel_size_m=" + size +
                          " -o " + quoted(out / size))
                  .exit_code,
              0);
  const ProgramResult result =
      run_program("merge " + quoted(out / "0.1" / "map.svx") + " " +
                  quoted(out / "0.2" / "map.svx") + " -o " + quoted(out / "both.svx"));
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.output, HasSubstr("voxels of 0.1 m and of 0.2 m cannot be merged"));
  EXPECT_THAT(result.output, HasSubstr((out / "0.2" / "map.svx").string()));
  EXPECT_FALSE(fs::exists(out / "both.svx"));
}

TEST(Salvage, WritesTheIntactTilesOfADamagedMap) {
  const fs::path data = office_extract("data", 3), out = empty_folder("out");
  ASSERT_EQ(run_program("run " + quoted(data) + " -q -o " + quoted(out)).exit_code, 0);
  cut_off(out / "map.svx");
  const ProgramResult check = run_program("check " + quoted(out / "map.svx"));
  EXPECT_EQ(check.exit_code, 3);
  const ProgramResult salvage =
      run_program("check " + quoted(out / "map.svx") + " --salvage " + quoted(out / "rest.svx"));
  EXPECT_EQ(salvage.exit_code, 0) << salvage.output;
  EXPECT_THAT(salvage.output, HasSubstr("blocks are lost"));
  EXPECT_THAT(run_program("check " + quoted(out / "rest.svx")).output, HasSubstr("intact"));
}

}  // namespace
}  // namespace stereovox
