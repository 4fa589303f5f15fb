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

namespace stereovox {
namespace {

using testing::HasSubstr;

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
      block.voxels[std::size_t(position(random))] = {state(random), std::uint32_t(random()),
                                                     std::uint16_t(1 + random() % 65535),
                                                     std::uint16_t(random())};
  }
  return map;
}

std::string bytes_of(const VoxelMap& map) {
  std::ostringstream out;
  write_voxel_map(out, map);
  return out.str();
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
  VoxelMap map = random_map(600);  // three chunks
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
    for (std::size_t i = 0; i < block->voxels.size(); ++i) {
      EXPECT_EQ(same->voxels[i].state, block->voxels[i].state);
      EXPECT_EQ(same->voxels[i].last_seen_ms, block->voxels[i].last_seen_ms);
      EXPECT_EQ(same->voxels[i].observations, block->voxels[i].observations);
      EXPECT_EQ(same->voxels[i].ignorance, block->voxels[i].ignorance);
    }
  }
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
  std::string newer = bytes, damaged = bytes;
  newer[14] = 9;
  damaged.back() = char(damaged.back() ^ 1);
  EXPECT_EQ(complaint_about(newer),
            "map.svx: has format version 9, this program reads versions 1 to 2");
  EXPECT_EQ(complaint_about(damaged), "map.svx: chunk 0 is damaged (its checksum does not match)");
  EXPECT_EQ(complaint_about("P5 640 480 255 and so on"), "map.svx: is not a stereovox map");
  EXPECT_EQ(complaint_about(bytes + "x"), "map.svx: bytes follow the end of the map");
}

VoxelMap without_ignorance(const VoxelMap& map) {
  VoxelMap plain(map.voxel_size_m(), map.floor_z_m());
  plain.epoch_ns = map.epoch_ns;
  plain.frames_integrated = map.frames_integrated;
  for (const VoxelBlock* const block : map.sorted_blocks()) {
    VoxelBlock& same = plain.find_or_create_block(block->index);
    same.voxels = block->voxels;
    for (Voxel& voxel : same.voxels) voxel.ignorance = 0;
  }
  return plain;
}

TEST(VoxelMapFile, OnlyAMapWithIgnoranceNeedsVersionTwo) {
  const VoxelMap map = random_map(3);
  const std::string with = bytes_of(map), without = bytes_of(without_ignorance(map));
  EXPECT_EQ(with[14], 2);
  EXPECT_EQ(without[14], 1);
  EXPECT_LT(without.size(), with.size());
}

TEST(VoxelMapFile, AMapOfVersionOneIsReadAndHasNoIgnorance) {
  const VoxelMap plain = without_ignorance(random_map(600));
  const std::string bytes = bytes_of(plain);
  const VoxelMap read = map_of(bytes);
  EXPECT_EQ(read.known_voxel_count(), plain.known_voxel_count());
  EXPECT_EQ(bytes_of(read), bytes);
}

// A header with valid checksum, as a hostile writer can make it.
std::string header(double voxel_size_m, std::uint64_t blocks, std::uint32_t attachments) {
  std::string bytes = "STEREOVOX-MAP\n";
  append_number(bytes, std::uint16_t{1});
  append_number(bytes, voxel_size_m);
  append_number(bytes, 0.0);
  append_number(bytes, std::uint8_t{0});
  append_number(bytes, std::int64_t{0});
  append_number(bytes, std::uint32_t{0});
  append_number(bytes, blocks);
  append_number(bytes, std::uint64_t{0});
  append_number(bytes, attachments);
  append_number(bytes, crc32c(bytes));
  return bytes;
}

std::string section_head(std::uint32_t blocks, std::uint32_t size, std::uint32_t compressed) {
  std::string bytes;
  for (const std::uint32_t number : {blocks, size, compressed}) append_number(bytes, number);
  return bytes;
}

TEST(VoxelMapFile, ImpossibleSizesAreRefusedBeforeTheyAreBelieved) {
  EXPECT_THAT(complaint_about(header(0.05, 1, 0) + section_head(1, 4'000'000'000U, 9)),
              HasSubstr("chunk 0 claims 4000000000 bytes"));
  EXPECT_THAT(complaint_about(header(0.05, 1, 0) + section_head(1, 100, 4'000'000'000U)),
              HasSubstr("claims 100 bytes, 4000000000 compressed"));
  EXPECT_THAT(complaint_about(header(0.05, 0, 1) + section_head(0, 67'000'000, 60'000'000)),
              HasSubstr("is cut off"));
  EXPECT_EQ(complaint_about(header(0.05, std::uint64_t{1} << 60, 0)), "map.svx: is cut off");
  EXPECT_THAT(complaint_about(header(-1.0, 0, 0)),
              HasSubstr("map.svx: header: voxel size is -1 m"));
}

TEST(VoxelMapFile, IsWrittenAndReadByPath) {
  const std::filesystem::path path = std::filesystem::temp_directory_path() /
                                     ("stereovox_map_" + std::to_string(getpid()) + ".svx");
  const VoxelMap map = random_map(5);
  write_voxel_map(path, map);
  EXPECT_EQ(bytes_of(read_voxel_map(path)), bytes_of(map));
  std::filesystem::remove(path);
  EXPECT_THROW(read_voxel_map(path), Error);
}

TEST(Crc32c, GivesThePublishedCheckValue) { EXPECT_EQ(crc32c("123456789"), 0xE3069283U); }

}  // namespace
}  // namespace stereovox
