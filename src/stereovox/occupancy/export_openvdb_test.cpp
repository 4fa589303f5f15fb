#include "stereovox/occupancy/export_openvdb.h"

#include <gtest/gtest.h>

#include "stereovox/core/error.h"

namespace stereovox {
namespace {

// What a grid holds is checked in export_openvdb_read_test.cpp, which only builds with OpenVDB
// have.
TEST(ExportOpenvdb, GridsAreReadBackWhereOpenvdbIsBuiltIn) {
  if (!has_openvdb()) GTEST_SKIP() << "this build has no OpenVDB";
}

TEST(ExportOpenvdb, ABuildWithoutOpenvdbSaysSo) {
  if (has_openvdb()) GTEST_SKIP() << "this build has OpenVDB";
  EXPECT_THROW(export_openvdb("map.vdb", VoxelMap(0.1), {}), UsageError);
}

}  // namespace
}  // namespace stereovox
