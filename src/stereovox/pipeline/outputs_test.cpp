#include "stereovox/pipeline/outputs.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "stereovox/core/error.h"
#include "stereovox/io/temporary_folder.h"
#include "stereovox/occupancy/voxel_map_file.h"

namespace stereovox {
namespace {

namespace fs = std::filesystem;

TEST(Outputs, AFolderIsMadeAndItsEarlierResultsAreProtected) {
  const TemporaryFolder folder;
  const fs::path out = folder.path() / "a" / "b";
  prepare_output_folder(out, false);
  EXPECT_TRUE(fs::is_directory(out));
  EXPECT_TRUE(fs::is_empty(out));
  std::ofstream(out / "map.svx") << "precious";
  EXPECT_THROW(prepare_output_folder(out, false), UsageError);
  EXPECT_NO_THROW(prepare_output_folder(out, true));
  EXPECT_EQ(fs::file_size(out / "map.svx"), 8U);
}

TEST(Outputs, AFolderThatCannotBeUsedIsAResourceError) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "file") << "x";
  EXPECT_THROW(prepare_output_folder(folder.path() / "file", false), ResourceError);
  EXPECT_THROW(prepare_output_folder(folder.path() / "file" / "below", false), ResourceError);
  EXPECT_THROW(prepare_output_folder("/proc/stereovox", false), ResourceError);
}

}  // namespace
}  // namespace stereovox
