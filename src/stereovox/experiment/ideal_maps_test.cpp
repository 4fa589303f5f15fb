#include "stereovox/experiment/ideal_maps.h"

#include <gmock/gmock.h>

#include "stereovox/io/temporary_folder.h"
#include "stereovox/simulation/room_for_test.h"

namespace stereovox {
namespace {

TEST(IdealMaps, FreeIsWhereTheRobotCanGet) {
  const World world = room_for_test();
  const IdealMap ideal = ideal_map(world, 0.25, {}, {1, 2});
  const OccupancyGrid2D& map = ideal.normalised;
  EXPECT_EQ(map.label_at(index_of(map.geometry, {1, 1})), CellLabel::free);
  EXPECT_EQ(map.label_at(index_of(map.geometry, {4.1, 2})), CellLabel::occupied);
  EXPECT_EQ(map.label_at(index_of(map.geometry, {4.6, 2.1})), CellLabel::unknown);  // inside
}

TEST(IdealMaps, VoxelsAreAllKnown) {
  const VoxelMap map = ideal_voxel_map(room_for_test(), 0.25);
  EXPECT_EQ(map.at(voxel_index_of(0.25, {4.6, 2.1, 0.5})).state, 1.0F);
  const Voxel above = map.at(voxel_index_of(0.25, {4.6, 2.1, 1.3}));
  EXPECT_TRUE(is_known(above));
  EXPECT_EQ(above.state, 0.0F);
  EXPECT_EQ(map.at(voxel_index_of(0.25, {1, 1, -0.1})).state, 1.0F);  // the floor
}

TEST(Doorways, AreWrittenAsTheyAreRead) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "doorways.yaml";
  write_doorways(path, {{"a \"b\": c", {1, 2}, {1.5, 2.25}}});
  const std::vector<Doorway> doorways = read_doorways(path);
  ASSERT_EQ(doorways.size(), 1U);
  EXPECT_EQ(doorways[0].name, "a \"b\": c");
  EXPECT_EQ(doorways[0].b_m, Eigen::Vector2d(1.5, 2.25));
  write_doorways(path, {});
  EXPECT_TRUE(read_doorways(path).empty());
}

}  // namespace
}  // namespace stereovox
