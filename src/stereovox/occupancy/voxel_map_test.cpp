#include "stereovox/occupancy/voxel_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <set>

#include "stereovox/core/error.h"

namespace stereovox {
namespace {

void set(VoxelMap& map, const Eigen::Vector3i& voxel, float state) {
  map.set(voxel, {state, 0, 1});
}

TEST(BlockIndex, VoxelsAndTheirPlaceInABlockAreInverse) {
  for (const Eigen::Vector3i& voxel : {Eigen::Vector3i(0, 0, 0), Eigen::Vector3i(-1, 7, 8),
                                       Eigen::Vector3i(-17, 100, -8), Eigen::Vector3i(5, -3, 2)})
    EXPECT_EQ(voxel_at(block_of(voxel), position_in_block(voxel)), voxel);
  EXPECT_EQ(block_of({-1, -8, -9}), Eigen::Vector3i(-1, -1, -2));
}

TEST(BlockIndex, FindsWhatWasInsertedAndNothingElse) {
  std::mt19937 random(3);
  std::uniform_int_distribution<int> coordinate(-kMaxBlockCoordinate, kMaxBlockCoordinate);
  BlockIndex index;
  std::vector<Eigen::Vector3i> blocks;
  for (int i = 0; i < 3000; ++i) {
    blocks.emplace_back(coordinate(random), coordinate(random), coordinate(random));
    EXPECT_EQ(index.find_or_insert(blocks.back()), i);
  }
  for (int i = 0; i < 3000; ++i) EXPECT_EQ(index.find(blocks[std::size_t(i)]), i);
  EXPECT_EQ(index.find({1, 2, 3}), BlockIndex::kNone);
  EXPECT_EQ(BlockIndex{}.find({1, 2, 3}), BlockIndex::kNone);
}

// Searches are short only if neighbours along every axis begin at different slots.
TEST(BlockIndex, SpreadsNeighboursAlongEveryAxis) {
  constexpr int kSide = 8;
  constexpr std::size_t kSlots = 4096;
  std::set<std::size_t> slots;
  for (int i = 0; i < kSide * kSide * kSide; ++i)
    slots.insert(hash_of(block_key({i % kSide, i / kSide % kSide, i / (kSide * kSide)})) % kSlots);
  // Thrown at random, 512 keys would take 481 slots.
  EXPECT_GT(slots.size(), 450U);
}

TEST(TileTable, FindsWhatWasInsertedAndNothingElse) {
  std::mt19937 random(4);
  std::uniform_int_distribution<int> coordinate(-kMaxBlockCoordinate, kMaxBlockCoordinate);
  TileTable table;
  std::vector<VoxelTile> tiles(500);
  for (VoxelTile& tile : tiles) {
    tile.index = {coordinate(random), coordinate(random), coordinate(random)};
    EXPECT_FALSE(TileTable::is_there(table.find(tile.index)));
    table.insert(tile);
  }
  for (VoxelTile& tile : tiles) EXPECT_EQ(&table.find(tile.index), &tile);
  EXPECT_FALSE(TileTable::is_there(table.find({1, 2, 3})));
  EXPECT_EQ(table.find({1, 2, 3}).blocks[0], nullptr);
}

TEST(VoxelMap, KnowsNothingAtFirst) {
  const VoxelMap map(0.05);
  EXPECT_EQ(map.find_block({0, 0, 0}), nullptr);
  EXPECT_FALSE(is_known(map.at({0, 0, 0})));
  EXPECT_FALSE(map.bounds().has_value());
  EXPECT_EQ(map.known_voxel_count(), 0U);
}

TEST(VoxelMap, UnknownVoxelsOfAnExistingBlockStayUnknown) {
  VoxelMap map(0.05);
  set(map, {1, 2, 3}, 0.75F);
  EXPECT_EQ(map.at({1, 2, 3}).state, 0.75F);
  EXPECT_FALSE(is_known(map.at({1, 2, 4})));
  EXPECT_EQ(map.known_voxel_count(), 1U);
}

TEST(VoxelMap, BoundsHoldTheKnownVoxelsOnly) {
  VoxelMap map(0.05);
  set(map, {-3, 20, 5}, 0.0F);
  set(map, {4, 2, 9}, 1.0F);
  EXPECT_EQ(map.bounds()->min, Eigen::Vector3i(-3, 2, 5));
  EXPECT_EQ(map.bounds()->max, Eigen::Vector3i(4, 20, 9));
}

TEST(VoxelMap, BlocksComeInCanonicalOrderWhateverTheOrderOfCreation) {
  VoxelMap map(0.05);
  for (const Eigen::Vector3i& block : {Eigen::Vector3i(1, 0, 0), Eigen::Vector3i(-1, 5, 0),
                                       Eigen::Vector3i(-1, -5, 9), Eigen::Vector3i(0, 0, 0)})
    map.find_or_create_block(block);
  std::vector<int> x;
  for (const VoxelBlock* block : map.sorted_blocks()) x.push_back(block->index.x());
  EXPECT_THAT(x, testing::ElementsAre(-1, -1, 0, 1));
  EXPECT_EQ(map.sorted_blocks().front()->index.y(), -5);
}

TEST(VoxelMap, ACopyIsIndependent) {
  VoxelMap map(0.05);
  set(map, {1, 2, 3}, 0.25F);
  VoxelMap copy = map;
  set(copy, {1, 2, 3}, 0.5F);
  EXPECT_EQ(map.at({1, 2, 3}).state, 0.25F);
}

TEST(VoxelMap, LooksUpFarBeyondTheLatticeSafely) {
  EXPECT_FALSE(is_known(VoxelMap(0.05).at({2'000'000'000, 0, 0})));
}

TEST(VoxelMap, RefusesImpossibleSizes) {
  for (const double size_m : {0.0, -0.05, 100.0, std::nan("")})
    EXPECT_THROW(VoxelMap map(size_m), Error) << size_m;
}

std::vector<Eigen::Vector3i> places_of(const std::vector<const VoxelBlock*>& blocks) {
  std::vector<Eigen::Vector3i> places;
  for (const VoxelBlock* block : blocks) places.push_back(block->index);
  return places;
}

TEST(VoxelMap, BlocksInABoxAreThoseThatItTouches) {
  std::mt19937 random(4);
  std::uniform_int_distribution<int> place(-20, 20), voxel(-200, 200);
  VoxelMap map(0.05);
  for (int i = 0; i < 2000; ++i)
    map.find_or_create_block({place(random), place(random), place(random)});
  for (int trial = 0; trial < 50; ++trial) {
    const Eigen::Vector3i a(voxel(random), voxel(random), voxel(random));
    const VoxelBounds box{a, a + Eigen::Vector3i::Constant(trial)};
    std::vector<Eigen::Vector3i> expected;
    for (const VoxelBlock* block : map.sorted_blocks()) {
      const Eigen::Array3i low = block->index.array() * kBlockSide;
      if ((low + kBlockSide > box.min.array()).all() && (low <= box.max.array()).all())
        expected.push_back(block->index);
    }
    EXPECT_EQ(places_of(map.blocks_in(box)), expected);
  }
}

TEST(VoxelMap, TellsWhichBlocksChangedSinceAStamp) {
  VoxelMap map(0.05);
  set(map, {0, 0, 0}, 0.5F);
  set(map, {100, 0, 0}, 0.5F);
  EXPECT_EQ(map.blocks_changed_since(0).size(), 2U);
  const ChangeStamp stamp = map.change_stamp();
  EXPECT_TRUE(map.blocks_changed_since(stamp).empty());
  set(map, {100, 0, 0}, 0.6F);
  set(map, {-1, 0, 0}, 0.6F);
  map.erase_block({0, 0, 0});
  EXPECT_THAT(map.blocks_changed_since(stamp),
              testing::ElementsAre(Eigen::Vector3i(-1, 0, 0), Eigen::Vector3i(0, 0, 0),
                                   Eigen::Vector3i(12, 0, 0)));
}

}  // namespace
}  // namespace stereovox
