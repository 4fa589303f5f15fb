// Grids read back by OpenVDB itself.
#include <gtest/gtest.h>
#include <openvdb/openvdb.h>
#include <unistd.h>

#include <string>

#include "stereovox/core/error.h"
#include "stereovox/core/grid_geometry.h"
#include "stereovox/occupancy/export_openvdb.h"

namespace stereovox {
namespace {

namespace fs = std::filesystem;

openvdb::FloatGrid::Ptr exported(const VoxelMap& map, const QueryParams& params = {}) {
  const fs::path path =
      fs::path(testing::TempDir()) / ("stereovox_export_" + std::to_string(getpid()) + ".vdb");
  export_openvdb(path, map, params);
  openvdb::io::File file(path.string());
  file.open();
  const openvdb::GridPtrVecPtr grids = file.getGrids();
  file.close();
  fs::remove(path);
  EXPECT_EQ(grids->size(), 1U);
  EXPECT_EQ(grids->front()->getName(), "occupancy");
  return openvdb::gridPtrCast<openvdb::FloatGrid>(grids->front());
}

VoxelMap small_map() {
  VoxelMap map(0.1, -0.25);
  map.set({0, 0, 0}, {.state = 0.75F, .observations = 3});
  map.set({-1, 2, 40}, {.state = 0.125F, .observations = 1});
  map.set({-9, 2, 7}, {.state = 0.0F, .observations = 2});
  return map;
}

openvdb::Coord coord(const Eigen::Vector3i& v) { return {v.x(), v.y(), v.z()}; }

TEST(ExportOpenvdb, HoldsTheStateOfEachKnownVoxel) {
  const VoxelMap map = small_map();
  const openvdb::FloatGrid::Ptr grid = exported(map);
  EXPECT_EQ(grid->activeVoxelCount(), map.known_voxel_count());
  map.for_each_block([&](const VoxelBlock& block) {
    for (int i = 0; i < kVoxelsPerBlock; ++i) {
      const Voxel voxel = block.voxels[static_cast<std::size_t>(i)];
      const openvdb::Coord place = coord(voxel_at(block.index, i));
      EXPECT_EQ(grid->tree().isValueOn(place), is_known(voxel));
      EXPECT_EQ(grid->tree().getValue(place), is_known(voxel) ? voxel.state : 0.5F);
    }
  });
  EXPECT_EQ(grid->background(), 0.5F);
}

TEST(ExportOpenvdb, LiesInTheWorldAsTheMapDoes) {
  const VoxelMap map = small_map();
  const openvdb::FloatGrid::Ptr grid = exported(map);
  EXPECT_NEAR(grid->voxelSize().x(), 0.1, 1e-12);
  const openvdb::Vec3d center_m = grid->indexToWorld(openvdb::Coord(-9, 2, 7));
  const Eigen::Vector3d expected_m = voxel_center_of(0.1, {-9, 2, 7});
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(center_m[axis], expected_m[axis], 1e-12);
  EXPECT_EQ(grid->metaValue<double>("floor_z_m"), -0.25);
}

TEST(ExportOpenvdb, LeavesOutWhatWasSeenTooSeldom) {
  const openvdb::FloatGrid::Ptr grid = exported(small_map(), {.min_observations = 2});
  EXPECT_EQ(grid->activeVoxelCount(), 2U);
  EXPECT_FALSE(grid->tree().isValueOn({-1, 2, 40}));
}

TEST(ExportOpenvdb, AnEmptyMapIsAnEmptyGrid) {
  EXPECT_EQ(exported(VoxelMap(0.1))->activeVoxelCount(), 0U);
}

TEST(ExportOpenvdb, AFileThatCannotBeWrittenIsAnError) {
  EXPECT_THROW(export_openvdb("/dev/null/map.vdb", small_map(), {}), ResourceError);
}

}  // namespace
}  // namespace stereovox
