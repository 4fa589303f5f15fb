#include "stereovox/occupancy/tile_store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stereovox/core/error.h"
#include "stereovox/io/temporary_folder.h"
#include "stereovox/occupancy/map_bytes_for_test.h"
#include "stereovox/occupancy/store_faults_for_test.h"
#include "stereovox/occupancy/voxel_map.h"
#include "stereovox/occupancy/voxel_map_file.h"

namespace stereovox {
namespace {

using testing::HasSubstr;

class TileStoreTest : public testing::Test {
 protected:
  TemporaryFolder folder_;
};

std::string complaint_of(const std::function<void()>& body) {
  try {
    body();
  } catch (const ResourceError& error) {
    return error.what();
  }
  return "";
}

TEST_F(TileStoreTest, GivesBackWhatWasWritten) {
  TileStore store(folder_.path());
  const std::string small = "a few bytes", large(100'000, 'x');
  const StoredPlace a = store.write(small), b = store.write(large);
  EXPECT_EQ(store.read(a), small);
  EXPECT_EQ(store.read(b), large);
}

TEST_F(TileStoreTest, LeavesNoFileInTheFolder) {
  TileStore store(folder_.path());
  store.write("something");
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

TEST_F(TileStoreTest, UsesReleasedPlacesAgain) {
  TileStore store(folder_.path());
  StoredPlace place = store.write(std::string(5000, 'a'));
  const std::uint64_t before = store.file_bytes();
  for (int i = 0; i < 100; ++i) {
    const StoredPlace next = store.write(std::string(5000, 'b'));
    store.release(place);
    place = next;
  }
  EXPECT_EQ(store.file_bytes(), 2 * before);
  EXPECT_EQ(store.bytes_in_use(), before);
  EXPECT_EQ(store.read(place), std::string(5000, 'b'));
}

TEST_F(TileStoreTest, AFolderThatIsNotThereIsOneClearLine) {
  EXPECT_EQ(complaint_of([&] { TileStore store(folder_.path() / "none"); }),
            "tile store in " + (folder_.path() / "none").string() +
                ": cannot be made (No such file or directory)");
}

// A map of tiles in a row with all voxels of one block known in each.
VoxelMap row_of_full_tiles(int tiles) {
  VoxelMap map(0.05);
  for (int x = 0; x < tiles; ++x) {
    BlockVoxels& voxels = map.find_or_create_block({x * kTileSide, 0, 0}).voxels;
    for (std::size_t i = 0; i < voxels.size(); ++i)
      voxels.set(i, {float(i) / 512.0F, std::uint32_t(x), 1});
  }
  return map;
}

TEST_F(TileStoreTest, AMapWithTilesOutAnswersAsIfTheyWereIn) {
  const VoxelMap all = row_of_full_tiles(50);
  VoxelMap map = row_of_full_tiles(50);
  map.use_store(folder_.path());
  map.keep_within(all.memory_bytes() / 2);
  EXPECT_LE(map.memory_bytes(), all.memory_bytes() / 2);
  EXPECT_GT(map.tiles_out(), 20U);
  EXPECT_EQ(map.block_count(), 50U);
  EXPECT_EQ(map.known_voxel_count(), all.known_voxel_count());
  EXPECT_EQ(map.bounds()->max, all.bounds()->max);
  EXPECT_TRUE(bytes_of(map) == bytes_of(all));
  EXPECT_GT(map.tiles_out(), 20U);  // all this read them without keeping them
  EXPECT_TRUE(bytes_of(VoxelMap(map)) == bytes_of(all));
  for (int x = 0; x < 50; ++x) EXPECT_EQ(map.at({x * 32 + 3, 0, 0}), all.at({x * 32 + 3, 0, 0}));
  EXPECT_EQ(map.tiles_out(), 0U);
  map.keep_within(0);
  EXPECT_EQ(map.sorted_blocks().size(), 50U);
}

TEST_F(TileStoreTest, TilesThatChangedLongestAgoGoOutFirst) {
  VoxelMap map = row_of_full_tiles(10);
  map.use_store(folder_.path());
  map.find_or_create_block({0, 0, 0});
  const ChangeStamp stamp = map.change_stamp();
  map.keep_within(map.memory_bytes() * 3 / 4);
  const std::size_t out = map.tiles_out();
  EXPECT_GT(out, 0U);
  map.at({0, 0, 0});
  EXPECT_EQ(map.tiles_out(), out);
  map.at({32, 0, 0});
  EXPECT_EQ(map.tiles_out(), out - 1);
  EXPECT_TRUE(map.blocks_changed_since(stamp).empty());  // going out and coming back is no change
}

TEST_F(TileStoreTest, ATileThatDidNotChangeIsNotWrittenAgain) {
  VoxelMap map = row_of_full_tiles(10);
  map.use_store(folder_.path());
  map.keep_within(0);
  const std::string before = bytes_of(map);
  const FileSizeLimit nothing_more(0);
  map.at({0, 0, 0});
  EXPECT_NO_THROW(map.keep_within(0));
  EXPECT_EQ(map.tiles_out(), 10U);
  EXPECT_TRUE(bytes_of(map) == before);
}

TEST_F(TileStoreTest, ChangesSurviveManyJourneys) {
  VoxelMap all = row_of_full_tiles(20), map = row_of_full_tiles(20);
  map.use_store(folder_.path());
  for (int round = 0; round < 10; ++round) {
    for (VoxelMap* const m : {&all, &map}) {
      m->set({round * 64 + 1, 2, 3}, {0.5F, std::uint32_t(round), 7, std::uint16_t(round)});
      if (round == 5) m->erase_block({8, 0, 0});
    }
    map.keep_within(0);
    EXPECT_TRUE(bytes_of(map) == bytes_of(all)) << round;
  }
}

TEST_F(TileStoreTest, AFullDiskLosesNothing) {
  VoxelMap map = row_of_full_tiles(20);
  map.use_store(folder_.path());
  const std::string before = bytes_of(map);
  {
    const FileSizeLimit full(20'000);
    EXPECT_EQ(complaint_of([&] { map.keep_within(0); }),
              "tile store in " + folder_.path().string() + ": cannot be written (File too large)");
  }
  EXPECT_GT(map.tiles_out(), 0U);
  EXPECT_LT(map.tiles_out(), 20U);
  EXPECT_TRUE(bytes_of(map) == before);
  map.keep_within(0);  // there is room again
  EXPECT_EQ(map.tiles_out(), 20U);
}

TEST_F(TileStoreTest, ADamagedTileIsNoticedAndTheRestCanBeSaved) {
  VoxelMap map = row_of_full_tiles(20);
  map.use_store(folder_.path());
  map.keep_within(0);
  damage_nameless_file(folder_.path(), 70);
  EXPECT_THAT(complaint_of([&] { map.sorted_blocks(); }),
              HasSubstr("tile (0, 0, 0): is damaged (its checksum does not match)"));
  EXPECT_EQ(map.forget_unreadable_tiles().size(), 1U);
  EXPECT_EQ(map.block_count(), 19U);
  EXPECT_EQ(map.known_voxel_count(), 19U * kVoxelsPerBlock);
  EXPECT_EQ(map.sorted_blocks().size(), 19U);
}

}  // namespace
}  // namespace stereovox
