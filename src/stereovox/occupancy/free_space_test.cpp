#include "stereovox/occupancy/free_space.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "stereovox/occupancy/scene_for_test.h"
#include "stereovox/occupancy/voxel_ray.h"

namespace stereovox {
namespace {

using VoxelSet = std::set<Eigen::Vector3i, LatticeOrder>;

// A view of a scene and its pyramid, filled pixel by pixel.
struct Seen {
  Seen(const scene::Frame& scene, const OccupancyParams& params)
      : map(params.voxel_size_m),
        frame(
            view_frame(scene.disparity, camera, scene.T_world_camera, scene.stamp_ns, params, map)),
        view(free_space_view(frame)),
        reach(samples(64), samples(48)) {
    const int step = frame.steps.ray_px, first = first_sample(step);
    for (int v = 0; v < reach.height(); ++v)
      for (int u = 0; u < reach.width(); ++u)
        reach.row(v)[u] =
            reach_of(free_end_m(frame, first + u * step, first + v * step), params.voxel_size_m);
    reach.build();
  }

  int samples(int pixels) const {
    const int step = frame.steps.ray_px;
    return (pixels - first_sample(step) + step - 1) / step;
  }
  VoxelSet by_voxels() const {
    constexpr int kReach = 90;
    VoxelSet crossed;
    for (int x = -kReach; x <= kReach; ++x)
      for (int y = -kReach; y <= kReach; ++y)
        for (int z = -kReach; z <= kReach; ++z)
          if (const Eigen::Vector3i v = view.camera_voxel + Eigen::Vector3i(x, y, z);
              is_crossed(view, reach, v))
            crossed.insert(v);
    return crossed;
  }
  VoxelSet by_blocks(int threads) const {
    VoxelSet crossed;
    for (const CrossedBlock& block : crossed_blocks(view, reach, threads))
      for_each_in(block.voxels, [&](int i) { crossed.insert(voxel_at(block.index, i)); });
    return crossed;
  }
  VoxelSet by_rays() const {
    VoxelSet crossed;
    for (int v = 0; v < 48; ++v)
      for (int u = 0; u < 64; ++u)
        if (const auto point = measure_pixel(frame, u, v))
          if (const auto segment = free_segment(frame, *point))
            for_each_voxel_on_segment(segment->from, segment->to, map.voxel_size_m(),
                                      [&](const Eigen::Vector3i& voxel) { crossed.insert(voxel); });
    return crossed;
  }

  RectifiedCamera camera = scene::camera();
  VoxelMap map;
  FrameView frame;
  FreeSpaceView view;
  ReachPyramid reach;
};

OccupancyParams params_with(double voxel_size_m, int step) {
  OccupancyParams params = scene::params(OccupancyPreset::corrected);
  params.voxel_size_m = voxel_size_m;
  params.ray_step_px = step;
  return params;
}

TEST(FreeSpace, BlocksHoldExactlyTheVoxelsThatAreCrossed) {
  for (unsigned seed = 0; seed < 6; ++seed)
    for (const int step : {1, 2, 5}) {
      const OccupancyParams params = params_with(seed % 2 == 0 ? 0.1 : 0.05, step);
      const std::vector<scene::Frame> drive = scene::random_drive(seed, 2);
      const Seen seen(drive.back(), params);
      const VoxelSet expected = seen.by_voxels();
      EXPECT_GT(expected.size(), 100U);
      EXPECT_TRUE(seen.by_blocks(1) == expected) << "seed " << seed << ", step " << step;
      EXPECT_TRUE(seen.by_blocks(3) == expected) << "seed " << seed << ", step " << step;
    }
}

TEST(FreeSpace, BlocksAreTheSameOnEveryTarget) {
  const Seen seen(scene::random_drive(9, 2).back(), params_with(0.05, 1));
  const auto on = [&](VectorTarget target) {
    return crossed_blocks(seen.view, seen.reach, 1, target);
  };
  const std::vector<CrossedBlock> plain = on(VectorTarget::portable);
  EXPECT_GT(plain.size(), 10U);
  for (const VectorTarget target : targets_here()) {
    const std::vector<CrossedBlock> fast = on(target);
    ASSERT_EQ(fast.size(), plain.size());
    for (std::size_t i = 0; i < fast.size(); ++i)
      EXPECT_EQ(fast[i].voxels.words, plain[i].voxels.words);
  }
}

// A wall leaves blocks that are crossed as a whole, which are not asked voxel by voxel.
TEST(FreeSpace, BlocksHoldExactlyTheVoxelsThatAreCrossedBeforeAWall) {
  for (const double yaw_rad : {0.0, 0.3, 1.9}) {
    const OccupancyParams params = params_with(0.04, 1);
    const scene::Frame wall{scene::wall_at(3.0), scene::level_pose(yaw_rad, {0.3, -0.2, 0.7}), 0};
    const Seen seen(wall, params);
    EXPECT_TRUE(seen.by_blocks(1) == seen.by_voxels()) << yaw_rad;
  }
}

// Rays that reach far are few here, so that they decide alone over voxels near the camera, whose
// faces are large in the image.
TEST(FreeSpace, BlocksHoldExactlyTheVoxelsThatLoneRaysCross) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> angle(-1.0F, 1.0F), near(0.0F, 4.0F), far(6.0F, 20.0F);
  for (int round = 0; round < 40; ++round) {
    const float share = round % 2 == 0 ? 0.001F : 1.0F;  // along the axes, nearly, or anyhow
    const Eigen::Quaternionf turn(1.0F, share * angle(random), share * angle(random),
                                  share * angle(random));
    const Eigen::Matrix3f R = turn.normalized().toRotationMatrix();
    FreeSpaceView view{
        .center_offset = {0.5F * angle(random), 0.5F * angle(random), 0.5F * angle(random)},
        .focal_x = 260.0F,
        .focal_y = 260.0F,
        .center_x = 160.0F,
        .center_y = 120.0F,
        .first_layer = -30,
        .last_layer = 30};
    for (int i = 0; i < 9; ++i) view.R_camera_world[static_cast<std::size_t>(i)] = R(i / 3, i % 3);
    ReachPyramid reach(320, 240);
    for (int v = 0; v < reach.height(); ++v)
      for (int u = 0; u < reach.width(); ++u) {
        const float reach_voxels = random() % 4000 == 0 ? far(random) : near(random);
        reach.row(v)[u] = reach_voxels * reach_voxels;
      }
    reach.build();
    VoxelSet expected, found;
    for (int x = -24; x <= 24; ++x)
      for (int y = -24; y <= 24; ++y)
        for (int z = -24; z <= 24; ++z)
          if (is_crossed(view, reach, {x, y, z})) expected.insert({x, y, z});
    for (const CrossedBlock& block : crossed_blocks(view, reach, 1))
      for_each_in(block.voxels, [&](int i) { found.insert(voxel_at(block.index, i)); });
    EXPECT_GT(expected.size(), 30U);
    EXPECT_TRUE(found == expected)
        << "round " << round << ": " << found.size() << " of " << expected.size();
  }
}

TEST(FreeSpace, IsNearlyWhatRaysCross) {
  const OccupancyParams params = params_with(0.1, 1);
  const scene::Frame wall{scene::wall_at(2.55), scene::level_pose(), 0};
  const Seen seen(wall, params);
  const VoxelSet projected = seen.by_blocks(1), walked = seen.by_rays();
  std::size_t both = 0, within_heights = 0;
  for (const Eigen::Vector3i& voxel : walked) {
    both += projected.count(voxel);
    within_heights += seen.view.first_layer <= voxel.z() && voxel.z() <= seen.view.last_layer;
  }
  EXPECT_GT(double(both), 0.98 * double(projected.size()));
  EXPECT_GT(double(both), 0.94 * double(within_heights));
}

TEST(FreeSpace, AHoleInTheImageShowsNothing) {
  const OccupancyParams params = params_with(0.1, 1);
  scene::Frame wall{scene::wall_at(2.55), scene::level_pose(), 0};
  wall.disparity.disparity_px(cv::Rect(20, 10, 25, 25)).setTo(0.0F);
  const VoxelSet crossed = Seen(wall, params).by_blocks(1);
  EXPECT_EQ(crossed.count({20, 0, 10}), 0U);
  EXPECT_EQ(crossed.count({20, 8, 10}), 1U);
}

TEST(FreeSpace, AnEmptyImageShowsNothing) {
  const scene::Frame empty{scene::empty_image(), scene::level_pose(), 0};
  EXPECT_TRUE(Seen(empty, params_with(0.1, 1)).by_blocks(1).empty());
}

}  // namespace
}  // namespace stereovox
