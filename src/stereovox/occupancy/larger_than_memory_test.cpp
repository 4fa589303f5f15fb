// A map forced into a part of its memory by the tile store equals the map without limit.
#include <gtest/gtest.h>

#include <sstream>

#include "stereovox/io/temporary_folder.h"
#include "stereovox/occupancy/integrate.h"
#include "stereovox/occupancy/scene_for_test.h"
#include "stereovox/occupancy/voxel_map_file.h"

namespace stereovox {
namespace {

struct Soak {
  std::string map_bytes;  // everything the map holds, bit by bit
  std::vector<std::vector<Eigen::Vector3i>> hits;
  std::size_t peak_bytes = 0, most_tiles_out = 0;
};

// A drive through a corridor of random things, along x and back.
std::vector<scene::Frame> there_and_back(int frames) {
  std::vector<scene::Frame> drive = scene::random_drive(3, frames);
  for (int i = 0; i < frames; ++i) {
    const int way = i < frames / 2 ? i : frames - i;
    drive[std::size_t(i)].T_world_camera.translation.x() += 0.9 * way;
  }
  return drive;
}

Soak drive_through(const std::vector<scene::Frame>& drive, const OccupancyParams& params,
                   int threads, std::optional<std::size_t> limit_bytes = std::nullopt) {
  const TemporaryFolder folder;
  VoxelMap map(params.voxel_size_m, 0.1);
  map.use_store(folder.path());
  Soak soak;
  for (const scene::Frame& f : drive) {
    soak.hits.push_back(
        integrate(f.disparity, scene::camera(), f.T_world_camera, f.stamp_ns, params, threads, map)
            .hits);
    if (limit_bytes) map.keep_within(*limit_bytes);
    soak.peak_bytes = std::max(soak.peak_bytes, map.memory_bytes());
    soak.most_tiles_out = std::max(soak.most_tiles_out, map.tiles_out());
  }
  std::ostringstream out;
  write_voxel_map(out, map);
  soak.map_bytes = out.str();
  return soak;
}

void expect_equal(const Soak& a, const Soak& b) {
  EXPECT_TRUE(a.map_bytes == b.map_bytes) << "maps differ";
  EXPECT_EQ(a.hits, b.hits);
}

OccupancyParams fine_params() {
  OccupancyParams params = scene::params(OccupancyPreset::corrected);
  params.voxel_size_m = 0.1;
  params.observed_set = ObservedSet::projected;
  return params;
}

TEST(LargerThanMemory, ATenthOfTheMemoryGivesTheSameMapForAnyNumberOfThreads) {
  const auto drive = there_and_back(60);
  const OccupancyParams params = fine_params();
  const Soak all = drive_through(drive, params, 1);
  const std::size_t limit = all.peak_bytes / 10;
  for (const int threads : {1, 2, 3, 8}) {
    const Soak limited = drive_through(drive, params, threads, limit);
    expect_equal(limited, all);
    EXPECT_LE(limited.peak_bytes, limit);
    EXPECT_GT(limited.most_tiles_out, 20U);
  }
}

TEST(LargerThanMemory, EveryUpdateRuleAndObservedSetGivesTheSameMap) {
  const auto drive = there_and_back(24);
  for (const char* rule : {"log_odds", "continuous_log_odds", "visibility", "dempster_shafer",
                           "saturating", "literal", "frequency"})
    for (const char* set : {"raycast", "projected", "frustum", "all"}) {
      SCOPED_TRACE(std::string(rule) + " " + set);
      OccupancyParams params = scene::params(OccupancyPreset::corrected);
      params.voxel_size_m = 0.2;
      apply_settings({{"update.type", rule}, {"observed_set", set}}, params);
      const Soak all = drive_through(drive, params, 2);
      expect_equal(drive_through(drive, params, 3, 0), all);
    }
}

}  // namespace
}  // namespace stereovox
