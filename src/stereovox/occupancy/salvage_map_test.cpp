#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <random>
#include <sstream>

#include "stereovox/core/error.h"
#include "stereovox/occupancy/map_bytes_for_test.h"
#include "stereovox/occupancy/tile_section.h"
#include "stereovox/occupancy/voxel_map_file.h"

namespace stereovox {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// A row of tiles, each with a block.
VoxelMap row_of_tiles(int tiles) {
  VoxelMap map(0.05);
  for (int x = 0; x < tiles; ++x)
    map.set({x * kTileSide * kBlockSide, 0, 0}, {.state = 0.1F * float(x), .observations = 1});
  map.attachments["note"] = "hello";
  return map;
}

SalvagedMap salvaged(const std::string& bytes) {
  const std::filesystem::path path = std::filesystem::temp_directory_path() /
                                     ("stereovox_salvage_" + std::to_string(getpid()) + ".svx");
  std::ofstream(path, std::ios::binary) << bytes;
  SalvagedMap result = salvage_voxel_map(path);
  std::filesystem::remove(path);
  return result;
}

// Where the section of the n-th tile begins.
std::size_t tile_offset(const std::string& bytes, int n) {
  std::size_t at = bytes.find(kTileMark);
  for (; n > 0; --n) at = bytes.find(kTileMark, at + 1);
  return at;
}

TEST(SalvageMap, AnIntactFileLosesNothing) {
  const VoxelMap map = row_of_tiles(5);
  const SalvagedMap result = salvaged(bytes_of(map));
  EXPECT_THAT(result.losses, IsEmpty());
  EXPECT_EQ(result.tiles, 5U);
  EXPECT_EQ(bytes_of(result.map), bytes_of(map));
}

TEST(SalvageMap, AFlippedBitCostsItsTileOnlyAndNamesIt) {
  const std::string bytes = bytes_of(row_of_tiles(5));
  for (const std::size_t inside : {std::size_t{0}, std::size_t{6}, kTileHeadBytes + 3}) {
    std::string damaged = bytes;
    damaged[tile_offset(bytes, 2) + inside] ^= 4;
    const SalvagedMap result = salvaged(damaged);
    EXPECT_THAT(result.losses, ElementsAre("tile (2, 0, 0) is lost: 1 blocks, 1 voxels")) << inside;
    EXPECT_EQ(result.tiles, 4U);
    EXPECT_FALSE(is_known(result.map.at({2 * 32, 0, 0})));
    EXPECT_EQ(result.map.at({3 * 32, 0, 0}).state, 0.1F * 3.0F);
    EXPECT_EQ(result.map.attachments.at("note"), "hello");
  }
}

TEST(SalvageMap, ACutOffFileKeepsTheTilesBeforeTheCut) {
  const std::string bytes = bytes_of(row_of_tiles(5));
  const SalvagedMap result = salvaged(bytes.substr(0, tile_offset(bytes, 3) + 20));
  EXPECT_THAT(result.losses,
              ElementsAre("the index at the end is damaged or missing", "2 of 5 blocks are lost"));
  EXPECT_EQ(result.tiles, 3U);
}

TEST(SalvageMap, TheCopyAtTheEndStandsInForADamagedHeader) {
  std::string damaged = bytes_of(row_of_tiles(3));
  damaged[20] ^= 1;
  const SalvagedMap result = salvaged(damaged);
  EXPECT_THAT(result.losses, ElementsAre("the header is damaged; its copy at the end is used"));
  EXPECT_EQ(result.tiles, 3U);
  EXPECT_EQ(result.map.voxel_size_m(), 0.05);
}

TEST(SalvageMap, DamagedAttachmentsLeaveTheTiles) {
  std::string damaged = bytes_of(row_of_tiles(3));
  damaged[kMapHeaderBytes + 14] ^= 1;
  const SalvagedMap result = salvaged(damaged);
  EXPECT_THAT(result.losses, ElementsAre("the attachments are damaged"));
  EXPECT_EQ(result.tiles, 3U);
}

TEST(SalvageMap, WithoutAnyHeaderThereIsNothingToSalvage) {
  std::string damaged = bytes_of(row_of_tiles(3));
  damaged[20] ^= 1;
  EXPECT_THROW(salvaged(damaged.substr(0, damaged.size() - 1)), Error);
  EXPECT_THROW(salvaged(""), Error);
}

TEST(SalvageMap, NoDamageIsTakenForAMap) {
  std::mt19937 random(4);
  VoxelMap map = row_of_tiles(4);
  const std::string bytes = bytes_of(map);
  for (int trial = 0; trial < 300; ++trial) {
    std::string damaged = bytes;
    for (int i = 0; i < 3; ++i) damaged[random() % damaged.size()] ^= char(1 << random() % 8);
    if (trial % 3 == 0) damaged.resize(random() % damaged.size());
    try {
      const SalvagedMap result = salvaged(damaged);
      EXPECT_TRUE(!result.losses.empty() || damaged == bytes);
      result.map.for_each_block([&](const VoxelBlock& block) {
        EXPECT_EQ(block.voxels[0], map.find_block(block.index)->voxels[0]);
      });
    } catch (const Error&) {
    }
  }
}

TEST(SalvageMap, OldVersionsKeepTheBlocksBeforeTheDamage) {
  std::ifstream file(
      std::string(STEREOVOX_SOURCE_DIR) + "/src/stereovox/occupancy/testdata/map_v1.svx",
      std::ios::binary);
  std::ostringstream bytes;
  bytes << file.rdbuf();
  EXPECT_THAT(salvaged(bytes.str()).losses, IsEmpty());
  const SalvagedMap result = salvaged(bytes.str().substr(0, bytes.str().size() - 1));
  ASSERT_EQ(result.losses.size(), 1U);
  EXPECT_THAT(result.losses.front(), HasSubstr("is cut off"));
}

}  // namespace
}  // namespace stereovox
