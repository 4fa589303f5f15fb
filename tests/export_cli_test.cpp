// Exported maps, read by the programs they are meant for.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <octomap/octomap.h>

#include <fstream>

#include "program.h"
#include "stereovox/core/grid_geometry.h"
#include "stereovox/occupancy/export_openvdb.h"
#include "stereovox/occupancy/voxel_map_file.h"

namespace stereovox {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class Export : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = empty_folder("out");
    const fs::path data = office_extract("data", 6);
    ASSERT_EQ(run_program("run " + quoted(data) + " -q -o " + quoted(folder_)).exit_code, 0);
  }

  fs::path exported(const std::string& name) {
    const fs::path path = folder_ / name;
    const ProgramResult result =
        run_program("export " + quoted(folder_ / "map.svx") + " -o " + quoted(path));
    EXPECT_EQ(result.exit_code, 0) << result.output;
    return path;
  }

  fs::path folder_;
};

// The tree knows the voxels that the map knows, and calls the same ones occupied.
void expect_same(const octomap::OcTree& tree, const VoxelMap& map) {
  std::size_t wrong = 0, volume = 0;
  map.for_each_block([&](const VoxelBlock& block) {
    for_each_in(block.voxels.known(), [&](int i) {
      const Eigen::Vector3d p = voxel_center_of(map.voxel_size_m(), voxel_at(block.index, i));
      const octomap::OcTreeNode* const node = tree.search(p.x(), p.y(), p.z());
      const bool is_occupied = block.voxels[std::size_t(i)].state > 0.5F;
      wrong += node == nullptr || tree.isNodeOccupied(node) != is_occupied ? 1U : 0U;
    });
  });
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf)
    volume += std::size_t{1} << 3 * (tree.getTreeDepth() - leaf.getDepth());
  EXPECT_EQ(wrong, 0U);
  EXPECT_EQ(volume, map.known_voxel_count());
}

TEST_F(Export, OctomapReadsBothOfItsForms) {
  const VoxelMap map = read_voxel_map(folder_ / "map.svx");
  octomap::OcTree binary(0.1);
  ASSERT_TRUE(binary.readBinary(exported("map.bt").string()));
  EXPECT_EQ(binary.getResolution(), map.voxel_size_m());
  expect_same(binary, map);

  const std::unique_ptr<octomap::AbstractOcTree> read(
      octomap::AbstractOcTree::read(exported("map.ot").string()));
  const auto* const full = dynamic_cast<octomap::OcTree*>(read.get());
  ASSERT_NE(full, nullptr);
  expect_same(*full, map);
}

// OctoMap itself would write the same bytes: our tree is pruned as theirs is.
TEST_F(Export, OctomapWritesTheSameBytes) {
  for (const std::string name : {"map.bt", "map.ot"}) {
    const fs::path ours = exported(name), theirs = folder_ / ("their_" + name);
    if (name == "map.bt") {
      octomap::OcTree tree(0.1);
      ASSERT_TRUE(tree.readBinary(ours.string()));
      ASSERT_TRUE(tree.writeBinary(theirs.string()));
    } else {
      const std::unique_ptr<octomap::AbstractOcTree> tree(
          octomap::AbstractOcTree::read(ours.string()));
      dynamic_cast<octomap::OcTree*>(tree.get())->updateInnerOccupancy();
      dynamic_cast<octomap::OcTree*>(tree.get())->prune();
      ASSERT_TRUE(tree->write(theirs.string()));
    }
    const auto data = [](const std::string& file) { return file.substr(file.find("\ndata\n")); };
    const auto size = [](const std::string& file) {
      return file.substr(file.find("\nsize"), file.find("\nres") - file.find("\nsize"));
    };
    EXPECT_TRUE(data(text_of(ours)) == data(text_of(theirs))) << name;
    EXPECT_EQ(size(text_of(ours)), size(text_of(theirs))) << name;
  }
}

TEST_F(Export, PointCloudsHoldTheOccupiedVoxels) {
  std::size_t occupied = 0;
  read_voxel_map(folder_ / "map.svx").for_each_block([&](const VoxelBlock& block) {
    for (const Voxel voxel : block.voxels) occupied += is_known(voxel) && voxel.state > 0.5F;
  });
  EXPECT_THAT(text_of(exported("map.ply")),
              HasSubstr("element vertex " + std::to_string(occupied) + "\n"));
  EXPECT_THAT(text_of(exported("map.pcd")), HasSubstr("POINTS " + std::to_string(occupied) + "\n"));
}

TEST_F(Export, AGridOfOpenvdbIsWrittenOrRefusedInOneLine) {
  if (has_openvdb()) {
    // The number that OpenVDB's files begin with.
    EXPECT_EQ(text_of(exported("map.vdb")).substr(0, 4), " BDV");
    return;
  }
  const ProgramResult result = run_program("export none.svx -o map.vdb");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.output, HasSubstr("map.vdb: this build has no OpenVDB"));
}

TEST_F(Export, AnUnknownFormIsRefusedBeforeAnyWork) {
  const ProgramResult result = run_program("export none.svx -o map.stl");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.output, HasSubstr("map.stl: no known form"));
}

}  // namespace
}  // namespace stereovox
