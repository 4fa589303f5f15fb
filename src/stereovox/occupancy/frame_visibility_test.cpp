#include "stereovox/occupancy/frame_visibility.h"

#include <gtest/gtest.h>

#include "stereovox/occupancy/scene_for_test.h"

namespace stereovox {
namespace {

void set_state(VoxelMap& map, const Eigen::Vector3i& index, float state) {
  map.set(index, {.state = state, .observations = 5});
}

OccupancyParams visibility_params() {
  OccupancyParams params = scene::params(OccupancyPreset::corrected);
  params.update = VisibilityRule{};
  return params;
}

// P(V) along the optical axis of a camera in voxel (0, 0, 5) that looks along +x at a wall in
// voxels 10 and 11: '1' fully visible, then 's' some, 'h' hidden (at most 0.1), ' ' not observed.
std::string row(VoxelMap map, const OccupancyParams& params, int threads = 1) {
  const DisparityImage wall = scene::wall_at(2.1);
  const RectifiedCamera camera = scene::camera();
  const FrameView frame =
      view_frame(wall, camera, scene::level_pose(0, {0.05, 0.1, 1.1}), 0, params, map);
  const FrameObservation observation = observe_frame(frame, map, threads);
  const auto visibility =
      frame_visibility(std::get<VisibilityRule>(params.update), frame, observation, map, threads);
  std::string row;
  for (int x = 0; x < 12; ++x) {
    const int block = observation.index.find(block_of({x, 0, 5}));
    const int position = position_in_block({x, 0, 5});
    const bool is_observed = block != BlockIndex::kNone &&
                             observation.blocks[std::size_t(block)].observed.contains(position);
    const float v = is_observed ? visibility[std::size_t(block)][std::size_t(position)] : 0.0F;
    row += !is_observed ? ' ' : v == 1.0F ? '1' : v > 0.1F ? 's' : 'h';
  }
  return row;
}

VoxelMap map_with(const OccupancyParams& params, int x, float state) {
  VoxelMap map(params.voxel_size_m);
  for (int y = -8; y < 8; ++y)
    for (int z = 0; z < 9; ++z) set_state(map, {x, y, z}, state);
  return map;
}

TEST(FrameVisibility, EverythingIsVisibleThroughUnknownSpaceThatHidesLittle) {
  const OccupancyParams params = visibility_params();
  EXPECT_EQ(row(VoxelMap(params.voxel_size_m), params), "111111111111");
}

TEST(FrameVisibility, AsPublishedUnknownSpaceHidesWhatIsBehindAFewVoxels) {
  OccupancyParams params = visibility_params();
  params.update = VisibilityRule{.unknown_occupancy = 0.5};
  EXPECT_EQ(row(VoxelMap(params.voxel_size_m), params), "1sssshhhhhhh");
}

TEST(FrameVisibility, AnOccupiedLayerHidesWhatIsBehindIt) {
  const OccupancyParams params = visibility_params();
  EXPECT_EQ(row(map_with(params, 4, 0.9F), params), "11111ssssssh");
}

TEST(FrameVisibility, AFreeLayerHidesNothing) {
  OccupancyParams params = visibility_params();
  EXPECT_EQ(row(map_with(params, 4, 0.1F), params), "111111111111");
}

TEST(FrameVisibility, TheLineEntersAVoxelAcrossTheAxisAlongWhichItIsFarthest) {
  const OccupancyParams params = visibility_params();
  const DisparityImage wall = scene::wall_at(2.1);
  const RectifiedCamera camera = scene::camera();
  VoxelMap map(params.voxel_size_m);
  const FrameView frame =
      view_frame(wall, camera, scene::level_pose(0, {0.05, 0.1, 1.1}), 0, params, map);
  const Eigen::Vector3i camera_voxel(0, 0, 5);
  const auto axis = [&](const Eigen::Vector3i& voxel) {
    return entry_axis(frame, voxel, camera_voxel - voxel);
  };
  EXPECT_EQ(axis({3, 1, 5}), 0);
  EXPECT_EQ(axis({3, -4, 5}), 1);
  EXPECT_EQ(axis({0, 0, 4}), 2);
  EXPECT_EQ(axis({2, 2, 5}), 0);  // the camera stands 5 cm before the middle of its voxel
}

}  // namespace
}  // namespace stereovox
