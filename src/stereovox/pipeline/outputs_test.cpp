#include "stereovox/pipeline/outputs.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "stereovox/io/temporary_folder.h"
#include "stereovox/occupancy/byte_buffer.h"
#include "stereovox/occupancy/voxel_map_file.h"

namespace stereovox {
namespace {

namespace fs = std::filesystem;

// The bytes of so many tiles with every face seen.
WallFaces many_faces(std::uint32_t tiles) {
  constexpr std::size_t kFaces = 256;
  std::string bytes = "wall faces 1\n";
  append_number(bytes, tiles);
  for (std::uint32_t t = 0; t < tiles; ++t) {
    append_number(bytes, static_cast<std::int32_t>(t));
    append_number(bytes, std::int32_t{0});
    bytes.append(kFaces / 8, '\xff');
    for (std::size_t i = 0; i < kFaces; ++i) {
      append_number(bytes, 0.01F);
      append_number(bytes, 1e6F);
    }
  }
  return wall_faces_from_bytes(bytes, "test");
}

class NoSequence : public StereoSequence {
 public:
  const StereoRig& rig() const override { return rig_; }
  const SequenceInfo& info() const override { return info_; }
  const Trajectory& truth() const override { return truth_; }
  std::optional<StereoFrame> next() override { return std::nullopt; }
  std::span<const SkippedPair> skipped() const override { return {}; }

 private:
  StereoRig rig_;
  SequenceInfo info_;
  Trajectory truth_;
};

BuildResult result_with(WallFaces faces) {
  BuildResult result;
  result.segments.push_back({0, {}, VoxelMap(0.1), {}, std::move(faces), {}});
  result.segments.front().map.set({0, 0, 5}, {.state = 0.9F, .observations = 5});
  return result;
}

TEST(Outputs, TooManyWallFacesAreLeftOutWithAWarningAndTheMapIsWritten) {
  const TemporaryFolder folder;
  constexpr std::uint32_t kFew = 10, kMany = 16'500;  // of 2088 bytes; 32 MiB may be written
  for (const std::uint32_t tiles : {kFew, kMany}) {
    BuildResult result = result_with(many_faces(tiles));
    write_outputs(folder.path(), NoSequence{}, PipelineConfig{}, result);
    const VoxelMap map = read_voxel_map(folder.path() / "map.svx");
    EXPECT_EQ(map.known_voxel_count(), 1U);
    EXPECT_EQ(map.attachments.contains(kWallFacesAttachment), tiles == kFew);
    EXPECT_EQ(result.warnings.size(), tiles == kFew ? 0U : 1U);
  }
}

TEST(Outputs, AMapTooWideForANavigationMapIsSavedWithoutOne) {
  const TemporaryFolder folder;
  BuildResult result = result_with({});
  result.segments.front().map.set({200'000, 200'000, 5}, {.state = 0.9F, .observations = 5});
  write_outputs(folder.path(), NoSequence{}, PipelineConfig{}, result);
  EXPECT_EQ(read_voxel_map(folder.path() / "map.svx").known_voxel_count(), 2U);
  for (const char* name : {"trajectory.tum", "report.json", "config.yaml"})
    EXPECT_TRUE(fs::exists(folder.path() / name)) << name;
  EXPECT_FALSE(fs::exists(folder.path() / "nav.yaml"));
  ASSERT_EQ(result.warnings.size(), 1U);
  EXPECT_TRUE(result.warnings.front().starts_with("there is no navigation map: "));
}

}  // namespace
}  // namespace stereovox
