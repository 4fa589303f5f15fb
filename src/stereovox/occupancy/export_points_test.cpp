#include "stereovox/occupancy/export_points.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "stereovox/occupancy/byte_buffer.h"

namespace stereovox {
namespace {

using testing::HasSubstr;

std::string exported(const VoxelMap& map, PointForm form, ExportedVoxels which,
                     const QueryParams& params = {}) {
  std::ostringstream out;
  export_points(out, form, map, params, which);
  return out.str();
}

VoxelMap small_map() {
  VoxelMap map(0.5);
  map.set({0, 0, 0}, {.state = 0.75F, .observations = 3});
  map.set({-1, 2, 4}, {.state = 0.875F, .observations = 1});
  map.set({1, 0, 0}, {.state = 0.25F, .observations = 3});
  return map;
}

// The first `count` floats after the header.
std::vector<float> floats_after(const std::string& file, const std::string& header_end, int count) {
  ByteReader reader(std::string_view(file).substr(file.find(header_end) + header_end.size()));
  std::vector<float> floats;
  for (int i = 0; i < count; ++i) floats.push_back(reader.number<float>());
  return floats;
}

TEST(ExportPoints, PcdHoldsCentresAndStatesOfOccupiedVoxels) {
  const std::string file = exported(small_map(), PointForm::pcd, ExportedVoxels::occupied);
  EXPECT_THAT(file, HasSubstr("WIDTH 2\n"));
  EXPECT_THAT(file, HasSubstr("POINTS 2\n"));
  EXPECT_EQ(floats_after(file, "DATA binary\n", 8),
            (std::vector<float>{-0.25F, 1.25F, 2.25F, 0.875F, 0.25F, 0.25F, 0.25F, 0.75F}));
  EXPECT_EQ(file.size(), file.find("DATA binary\n") + 12 + 32);
}

TEST(ExportPoints, PlyAddsColours) {
  const std::string file = exported(small_map(), PointForm::ply, ExportedVoxels::occupied);
  EXPECT_THAT(file, HasSubstr("element vertex 2\n"));
  EXPECT_EQ(floats_after(file, "end_header\n", 4),
            (std::vector<float>{-0.25F, 1.25F, 2.25F, 0.875F}));
  EXPECT_EQ(file.size(), file.find("end_header\n") + 11 + 2 * 19);
}

TEST(ExportPoints, FreeVoxelsAndSeldomSeenOnesAreAsked) {
  const VoxelMap map = small_map();
  EXPECT_THAT(exported(map, PointForm::pcd, ExportedVoxels::known), HasSubstr("POINTS 3\n"));
  EXPECT_THAT(exported(map, PointForm::pcd, ExportedVoxels::occupied, {.min_observations = 2}),
              HasSubstr("POINTS 1\n"));
  EXPECT_THAT(exported(map, PointForm::pcd, ExportedVoxels::occupied, {.threshold = 0.8F}),
              HasSubstr("POINTS 1\n"));
}

}  // namespace
}  // namespace stereovox
