#include "stereovox/occupancy/voxel_map_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <random>
#include <sstream>

#include "stereovox/core/error.h"
#include "stereovox/occupancy/byte_buffer.h"
#include "stereovox/occupancy/crc32c.h"
#include "stereovox/occupancy/map_bytes_for_test.h"
#include "stereovox/occupancy/tile_section.h"

namespace stereovox {
namespace {

using testing::HasSubstr;
using testing::MatchesRegex;

std::filesystem::path temporary_path() {
  return std::filesystem::temp_directory_path() /
         ("stereovox_map_" + std::to_string(getpid()) + ".svx");
}

VoxelMap random_map(int blocks, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> coordinate(-30, 30), position(0, kVoxelsPerBlock - 1);
  std::uniform_real_distribution<float> state(0.0F, 1.0F);
  VoxelMap map(0.05, -0.125);
  map.epoch_ns = 1'403'636'579'763'555'584;
  map.frames_integrated = 17;
  for (int b = 0; b < blocks; ++b) {
    VoxelBlock& block =
        map.find_or_create_block({coordinate(random), coordinate(random), coordinate(random)});
    for (int i = 0; i < 40; ++i)
      block.voxels.set(std::size_t(position(random)),
                       {state(random), std::uint32_t(random()), std::uint16_t(1 + random() % 65535),
                        std::uint16_t(random())});
  }
  return map;
}

VoxelMap map_of(const std::string& bytes) {
  std::istringstream in(bytes);
  return read_voxel_map(in, "map.svx");
}

std::string complaint_about(const std::string& bytes) {
  try {
    map_of(bytes);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(VoxelMapFile, KeepsEverything) {
  VoxelMap map = random_map(600);
  map.attachments = {{"configuration", "voxel_size_m: 0.05\n"}, {"empty", ""}};
  const VoxelMap read = map_of(bytes_of(map));
  EXPECT_EQ(read.voxel_size_m(), 0.05);
  EXPECT_EQ(read.floor_z_m(), -0.125);
  EXPECT_EQ(read.epoch_ns, map.epoch_ns);
  EXPECT_EQ(read.frames_integrated, 17U);
  EXPECT_EQ(read.attachments, map.attachments);
  ASSERT_EQ(read.block_count(), map.block_count());
  for (const VoxelBlock* block : map.sorted_blocks()) {
    const VoxelBlock* const same = read.find_block(block->index);
    ASSERT_NE(same, nullptr);
    for (std::size_t i = 0; i < block->voxels.size(); ++i)
      EXPECT_EQ(same->voxels[i], block->voxels[i]);
  }
}

std::vector<SurfacePoint> floor_points(double z_m) {
  return std::vector<SurfacePoint>(20, {{1.2, 3.4, z_m}, true});
}

TEST(VoxelMapFile, KeepsTheFloorThatWasSeen) {
  VoxelMap map = random_map(3);
  map.attachments["note"] = "hello";
  map.floor.observe(floor_points(-0.05), {0, 0, 1});
  ASSERT_EQ(map.floor.squares().size(), 1U);
  const VoxelMap read = map_of(bytes_of(map));
  EXPECT_EQ(read.floor, map.floor);
  EXPECT_EQ(read.attachments, map.attachments);
  EXPECT_EQ(bytes_of(read), bytes_of(map));
}

TEST(VoxelMapFile, AnEmptyMapIsAMap) {
  const VoxelMap read = map_of(bytes_of(VoxelMap(0.1)));
  EXPECT_EQ(read.block_count(), 0U);
  EXPECT_FALSE(read.epoch_ns.has_value());
}

TEST(VoxelMapFile, TheSameMapGivesTheSameBytesWhateverItsHistory) {
  const VoxelMap map = random_map(100);
  VoxelMap reversed(0.05, -0.125);
  reversed.epoch_ns = map.epoch_ns;
  reversed.frames_integrated = map.frames_integrated;
  const auto blocks = map.sorted_blocks();
  for (auto block = blocks.rbegin(); block != blocks.rend(); ++block)
    reversed.find_or_create_block((*block)->index).voxels = (*block)->voxels;
  reversed.find_or_create_block({500, 0, 0});  // knows nothing
  EXPECT_EQ(bytes_of(reversed), bytes_of(map));
  EXPECT_EQ(bytes_of(map_of(bytes_of(map))), bytes_of(map));
}

TEST(VoxelMapFile, EveryTruncationIsRefused) {
  VoxelMap map = random_map(3);
  map.attachments["note"] = "hello";
  const std::string bytes = bytes_of(map);
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_EQ(complaint_about(bytes.substr(0, size)), "map.svx: is cut off") << size;
}

TEST(VoxelMapFile, EveryFlippedBitIsNoticed) {
  VoxelMap map = random_map(2);
  map.attachments["note"] = "hello";
  const std::string bytes = bytes_of(map);
  for (std::size_t at = 0; at < bytes.size(); ++at)
    for (int bit = 0; bit < 8; ++bit) {
      std::string damaged = bytes;
      damaged[at] = char(damaged[at] ^ (1 << bit));
      EXPECT_THAT(complaint_about(damaged), testing::StartsWith("map.svx: ")) << at << " " << bit;
    }
}

TEST(VoxelMapFile, SaysWhatIsWrong) {
  const std::string bytes = bytes_of(random_map(2));
  std::string newer = bytes, damaged = bytes, no_tile = bytes;
  newer[14] = 9;
  damaged[kMapHeaderBytes + kTileHeadBytes] ^= 1;
  no_tile[kMapHeaderBytes] = 'X';
  EXPECT_EQ(complaint_about(newer),
            "map.svx: has format version 9, this program reads versions 1 to 3");
  EXPECT_THAT(complaint_about(damaged),
              MatchesRegex("map.svx: tile \\(.*\\) is damaged \\(its checksum does not match\\)"));
  EXPECT_EQ(complaint_about(no_tile), "map.svx: a tile has no mark where it should begin");
  EXPECT_EQ(complaint_about("P5 640 480 255 and so on"), "map.svx: is not a stereovox map");
  EXPECT_EQ(complaint_about(bytes + "x"), "map.svx: bytes follow the end of the map");
}

TEST(VoxelMapFile, OnlyTilesWithIgnoranceTakeRoomForIt) {
  VoxelMap map(0.1);
  map.set({0, 0, 0}, {.state = 0.5F, .observations = 1});
  const std::string without = bytes_of(map);
  map.set({0, 0, 0}, {.state = 0.5F, .observations = 1, .ignorance = 7});
  const std::string with = bytes_of(map);
  EXPECT_EQ(without[kMapHeaderBytes + 16], 0);
  EXPECT_EQ(with[kMapHeaderBytes + 16], 1);
  EXPECT_EQ(map_of(with).at({0, 0, 0}).ignorance, 7);
}

// Files that earlier programs wrote, and what they hold.
std::filesystem::path golden(const std::string& name) {
  return std::filesystem::path(STEREOVOX_SOURCE_DIR) / "src/stereovox/occupancy/testdata" / name;
}

TEST(VoxelMapFile, FilesOfEveryVersionAreRead) {
  for (const char* name : {"map_v1.svx", "map_v2.svx", "map_v3.svx"}) {
    const VoxelMap map = read_voxel_map(golden(name));
    EXPECT_EQ(map.voxel_size_m(), 0.5) << name;
    EXPECT_EQ(map.frames_integrated, 2U) << name;
    EXPECT_EQ(map.known_voxel_count(), 562U) << name;
    EXPECT_EQ(map.attachments.size(), 2U) << name;
  }
}

TEST(VoxelMapFile, AMapReadFromVersionOneIsWrittenAsVersionThree) {
  std::ifstream file(golden("map_v3.svx"), std::ios::binary);
  std::ostringstream expected;
  expected << file.rdbuf();
  EXPECT_TRUE(bytes_of(read_voxel_map(golden("map_v1.svx"))) == expected.str());
}

TEST(VoxelMapFile, DamagedFilesOfOldVersionsAreRefused) {
  std::ifstream file(golden("map_v2.svx"), std::ios::binary);
  std::ostringstream bytes;
  bytes << file.rdbuf();
  std::string damaged = bytes.str();
  damaged.back() ^= 1;
  EXPECT_EQ(complaint_about(damaged), "map.svx: chunk 0 is damaged (its checksum does not match)");
  EXPECT_EQ(complaint_about(bytes.str().substr(0, damaged.size() / 2)), "map.svx: is cut off");
}

// A header with valid checksum, as a hostile writer can make it.
std::string header(std::uint16_t version, double voxel_size_m, std::uint64_t blocks,
                   std::uint32_t attachments) {
  return encode_header({.version = version,
                        .voxel_size_m = voxel_size_m,
                        .blocks = blocks,
                        .attachments = attachments});
}

std::string section_head(std::uint32_t blocks, std::uint32_t size, std::uint32_t compressed) {
  std::string bytes;
  for (const std::uint32_t number : {blocks, size, compressed}) append_number(bytes, number);
  return bytes;
}

std::string tile_head(int x, std::uint32_t blocks, std::uint32_t known, std::uint32_t size,
                      std::uint32_t compressed) {
  std::string bytes(kTileMark);
  for (const int coordinate : {x, 0, 0}) append_number(bytes, coordinate);
  append_number(bytes, std::uint8_t{0});
  bytes += section_head(blocks, known, size);
  append_number(bytes, compressed);
  append_number(bytes, crc32c(bytes));
  return bytes;
}

TEST(VoxelMapFile, ImpossibleSizesAreRefusedBeforeTheyAreBelieved) {
  EXPECT_THAT(complaint_about(header(1, 0.05, 1, 0) + section_head(1, 4'000'000'000U, 9)),
              HasSubstr("chunk 0 claims 4000000000 bytes"));
  EXPECT_THAT(complaint_about(header(1, 0.05, 1, 0) + section_head(1, 100, 4'000'000'000U)),
              HasSubstr("claims 100 bytes, 4000000000 compressed"));
  EXPECT_THAT(complaint_about(header(3, 0.05, 0, 1) + section_head(0, 67'000'000, 60'000'000)),
              HasSubstr("is cut off"));
  EXPECT_EQ(complaint_about(header(3, 0.05, std::uint64_t{1} << 60, 0)), "map.svx: is cut off");
  EXPECT_THAT(complaint_about(header(3, -1.0, 0, 0)),
              HasSubstr("map.svx: header: voxel size is -1 m"));
  const std::string start = header(3, 0.05, 9, 0);
  EXPECT_THAT(complaint_about(start + tile_head(0, 65, 65, 10, 10)),
              HasSubstr("impossible number"));
  EXPECT_THAT(complaint_about(start + tile_head(0, 1, 513, 10, 10)),
              HasSubstr("impossible number"));
  EXPECT_THAT(complaint_about(start + tile_head(0, 1, 1, 9000, 10)), HasSubstr("more bytes"));
  EXPECT_THAT(complaint_about(start + tile_head(0, 1, 1, 100, 4'000'000'000U)),
              HasSubstr("more bytes"));
  EXPECT_THAT(complaint_about(start + tile_head(300'000, 1, 1, 10, 10)),
              HasSubstr("outside the lattice"));
}

TEST(VoxelMapFile, TilesAreReadOneByOne) {
  const std::filesystem::path path = temporary_path();
  const VoxelMap map = random_map(300);
  write_voxel_map(path, map);
  VoxelMapTiles file(path);
  EXPECT_EQ(file.header().known_voxels, map.known_voxel_count());
  VoxelMap again = file.empty_map();
  std::size_t known = 0;
  for (const TileListing& tile : file.tiles()) {
    file.read(tile, again);
    EXPECT_EQ(again.known_voxel_count(), known += tile.known_voxels);
  }
  EXPECT_EQ(bytes_of(again), bytes_of(map));
  std::filesystem::remove(path);
}

TEST(VoxelMapFile, IsWrittenAndReadByPath) {
  const std::filesystem::path path = temporary_path();
  const VoxelMap map = random_map(5);
  write_voxel_map(path, map);
  EXPECT_EQ(bytes_of(read_voxel_map(path)), bytes_of(map));
  std::filesystem::remove(path);
  EXPECT_THROW(read_voxel_map(path), Error);
}

TEST(Crc32c, GivesThePublishedCheckValue) { EXPECT_EQ(crc32c("123456789"), 0xE3069283U); }

}  // namespace
}  // namespace stereovox
