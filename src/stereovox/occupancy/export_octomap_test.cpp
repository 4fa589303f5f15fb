#include "stereovox/occupancy/export_octomap.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "stereovox/core/error.h"

namespace stereovox {
namespace {

std::string exported(const VoxelMap& map, OctomapForm form, const QueryParams& params = {}) {
  std::ostringstream out;
  export_octomap(out, form, map, params);
  return out.str();
}

void set(VoxelMap& map, const Eigen::Vector3i& voxel, float state, std::uint16_t count = 1) {
  map.set(voxel, {.state = state, .observations = count});
}

// The numbers of the data after the header.
std::vector<int> data_of(const std::string& file) {
  const std::string data = file.substr(file.find("data\n") + 5);
  std::vector<int> numbers;
  for (const char c : data) numbers.push_back(static_cast<unsigned char>(c));
  return numbers;
}

TEST(ExportOctomap, OneOccupiedVoxelAtTheOriginHasTheKnownBytes) {
  VoxelMap map(0.1);
  set(map, {0, 0, 0}, 0.9F);
  const std::string file = exported(map, OctomapForm::binary);
  EXPECT_THAT(file, testing::StartsWith(
                        "# Octomap OcTree binary file\nid OcTree\nsize 17\nres 0.1\ndata\n"));
  // The origin is in the upper half of each axis: child 7 of the root, then child 0 down to the
  // leaf.
  std::vector<int> expected = {0x00, 0xC0};
  for (int level = 0; level < 14; ++level) expected.insert(expected.end(), {0x03, 0x00});
  expected.insert(expected.end(), {0x02, 0x00});
  EXPECT_EQ(data_of(file), expected);
}

TEST(ExportOctomap, ChildrenGoByXThenYThenZ) {
  VoxelMap along_x(0.1), along_z(0.1);
  set(along_x, {1, 0, 0}, 0.9F);
  set(along_z, {0, 0, 1}, 0.9F);
  const auto last_node = [](const VoxelMap& map) {
    const std::vector<int> data = data_of(exported(map, OctomapForm::binary));
    return std::vector<int>(data.end() - 2, data.end());
  };
  EXPECT_EQ(last_node(along_x), (std::vector<int>{0x08, 0x00}));  // child 1 is occupied
  EXPECT_EQ(last_node(along_z), (std::vector<int>{0x00, 0x02}));  // child 4 is
}

TEST(ExportOctomap, EightEqualVoxelsAreOneLeaf) {
  VoxelMap map(0.1);
  for (int i = 0; i < 8; ++i) set(map, {i & 1, i >> 1 & 1, i >> 2}, 0.9F);
  const std::string file = exported(map, OctomapForm::binary);
  EXPECT_THAT(file, testing::HasSubstr("size 16\n"));
  EXPECT_EQ(data_of(file).size(), 30U);
  set(map, {1, 1, 1}, 0.1F);
  EXPECT_THAT(exported(map, OctomapForm::binary), testing::HasSubstr("size 24\n"));
}

TEST(ExportOctomap, AnEmptyMapIsAFileWithoutNodes) {
  EXPECT_THAT(exported(VoxelMap(0.1), OctomapForm::full),
              testing::EndsWith("size 0\nres 0.1\ndata\n"));
}

TEST(ExportOctomap, WhatOctomapCannotHoldIsRefused) {
  VoxelMap map(0.1);
  set(map, {32767, 0, -32768}, 0.9F);
  EXPECT_NO_THROW(exported(map, OctomapForm::binary));
  set(map, {32768, 0, 0}, 0.9F);
  EXPECT_THROW(exported(map, OctomapForm::binary), Error);
}

}  // namespace
}  // namespace stereovox
