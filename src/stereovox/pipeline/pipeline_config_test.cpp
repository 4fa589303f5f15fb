#include "stereovox/pipeline/pipeline_config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "stereovox/core/error.h"

namespace stereovox {
namespace {

std::filesystem::path written(const std::string& text) {
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "config.yaml";
  std::ofstream(path) << text;
  return path;
}

std::string complaint_about(const std::string& yaml) {
  PipelineConfig config;
  try {
    apply_settings(read_settings(written(yaml)), config);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(PipelineConfig, IsTheSameAfterWritingAndReading) {
  PipelineConfig config;
  apply_settings({{"matcher.type", "bm"},
                  {"matcher.texture_threshold", "77"},
                  {"occupancy.preset", "literal"},
                  {"occupancy.voxel_size_m", "0.1"},
                  {"world.level", "given"}},
                 config);
  PipelineConfig read_back;
  apply_settings(read_settings(written(to_yaml(config))), read_back);
  EXPECT_EQ(to_yaml(read_back), to_yaml(config));
  EXPECT_EQ(std::get<BlockMatchingParams>(read_back.matcher).texture_threshold, 77);
}

TEST(PipelineConfig, EveryDefaultIsWithinItsRange) {
  PipelineConfig config;
  const ParameterList list = parameters_of(config);
  for (const Parameter& p : list.parameters()) EXPECT_NO_THROW(p.set(p.get())) << p.path;
}

TEST(PipelineConfig, WrongKeysAndFilesAreErrors) {
  EXPECT_EQ(complaint_about("occupancy:\n  voxel_size: 0.1\n"),
            "unknown parameter 'occupancy.voxel_size', did you mean 'occupancy.voxel_size_m'?");
  EXPECT_THAT(complaint_about("- 1\n- 2\n"), testing::EndsWith("is not a map of parameters"));
  EXPECT_THAT(complaint_about("matcher: [1, 2]\n"),
              testing::EndsWith("'matcher' is neither a value nor a section"));
  EXPECT_EQ(complaint_about(""), "");
}

TEST(PipelineConfig, SettingsOfTheCommandLineNeedAnEqualsSign) {
  EXPECT_EQ(parse_settings({"a.b=c=d"}), (Settings{{"a.b", "c=d"}}));
  EXPECT_THROW(parse_settings({"a.b"}), UsageError);
}

TEST(PipelineConfig, TheReferencePageIsUpToDate) {
  std::ifstream file(std::string(STEREOVOX_SOURCE_DIR) + "/docs/parameters.md");
  std::stringstream page;
  page << file.rdbuf();
  EXPECT_EQ(page.str(), parameters_page())
      << "docs/parameters.md is stale: stereovox info --parameters > docs/parameters.md";
}

}  // namespace
}  // namespace stereovox
