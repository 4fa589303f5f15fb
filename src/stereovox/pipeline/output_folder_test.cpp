#include "stereovox/pipeline/output_folder.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <optional>

#include "stereovox/core/error.h"
#include "stereovox/io/temporary_folder.h"

namespace stereovox {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

void write(const fs::path& path, const std::string& text) {
  fs::create_directories(path.parent_path());
  std::ofstream(path) << text;
}

std::string text_in(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(OutputFolder, IsMadeAndItsEarlierResultsAreProtected) {
  const TemporaryFolder folder;
  const fs::path out = folder.path() / "a" / "b";
  {
    const OutputFolder made(out, false);
    EXPECT_FALSE(made.holds_results());
  }
  EXPECT_TRUE(fs::is_empty(out));
  write(out / "map.svx", "precious");
  EXPECT_THROW(OutputFolder(out, false), UsageError);
  EXPECT_TRUE(OutputFolder(out, true).holds_results());
  EXPECT_EQ(text_in(out / "map.svx"), "precious");
}

TEST(OutputFolder, ThatCannotBeUsedIsAResourceError) {
  const TemporaryFolder folder;
  write(folder.path() / "file", "x");
  EXPECT_THROW(OutputFolder(folder.path() / "file", false), ResourceError);
  EXPECT_THROW(OutputFolder(folder.path() / "file" / "below", false), ResourceError);
  EXPECT_THROW(OutputFolder("/proc/stereovox", false), ResourceError);
}

TEST(OutputFolder, ANewRunReplacesAllOfTheOneBefore) {
  const TemporaryFolder folder;
  const fs::path out = folder.path();
  for (const char* name : {"map.svx", "nav.pgm", "segment_2/map.svx", "segment_3/nav.png",
                           "segment_3/mine.txt", "segments/map.svx", "mine.txt"})
    write(out / name, "old");
  OutputFolder output(out, true);
  for (const char* name : {"map.svx", "report.json", "segment_2/nav.pgm"})
    write(output.staging() / name, "new");
  EXPECT_EQ(text_in(out / "map.svx"), "old");
  output.publish();
  for (const char* name : {"map.svx", "report.json", "segment_2/nav.pgm"})
    EXPECT_EQ(text_in(out / name), "new") << name;
  for (const char* name : {"nav.pgm", "segment_2/map.svx", "segment_3/nav.png"})
    EXPECT_FALSE(fs::exists(out / name)) << name;
  for (const char* name : {"mine.txt", "segment_3/mine.txt", "segments/map.svx"})
    EXPECT_EQ(text_in(out / name), "old") << name;
}

TEST(OutputFolder, WhatIsNotPublishedLeavesNoTrace) {
  const TemporaryFolder folder;
  write(folder.path() / "map.svx", "old");
  write(folder.path() / ".stereovox_new" / "map.svx", "of a killed run");
  {
    const OutputFolder output(folder.path(), true);
    EXPECT_FALSE(fs::exists(output.staging()));
    write(output.staging() / "map.svx", "new");
  }
  EXPECT_EQ(text_in(folder.path() / "map.svx"), "old");
  EXPECT_FALSE(fs::exists(folder.path() / ".stereovox_new"));
}

TEST(OutputFolder, IsOfOneProcessAtATime) {
  const TemporaryFolder folder;
  std::optional<OutputFolder> first(std::in_place, folder.path(), false);
  try {
    const OutputFolder second(folder.path(), true);
    FAIL() << "both may write";
  } catch (const ResourceError& error) {
    EXPECT_THAT(error.what(), HasSubstr(fmt::format("process {} is writing", ::getpid())));
  }
  first.reset();
  EXPECT_NO_THROW(OutputFolder(folder.path(), false));
}

}  // namespace
}  // namespace stereovox
