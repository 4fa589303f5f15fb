// What a frame costs in maps of different sizes: the same frames are added to maps that already
// hold 10^5 to 10^8 known voxels elsewhere. It should not depend on them.
//
//   map_growth [--voxels N]... [--frames N] [--voxel M]
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "map_engine_world.h"
#include "stereovox/core/grid_geometry.h"
#include "stereovox/occupancy/integrate.h"
#include "timing.h"

namespace stereovox::bench {
namespace {

struct Options {
  std::vector<double> voxels = {1e5, 1e6, 1e7, 1e8};
  int frames = 20;
  double voxel_m = 0.05;
};

// Blocks in layers beside the office, as dense as a map has them.
void fill(VoxelMap& map, double voxels) {
  constexpr int kWide = 200, kHigh = 8, kFirst = 60;
  auto left = static_cast<std::int64_t>(voxels);
  for (int n = 0; left > 0; ++n, left -= kVoxelsPerBlock) {
    BlockVoxels& block =
        map.find_or_create_block({kFirst + n / (kWide * kHigh), n / kHigh % kWide, n % kHigh})
            .voxels;
    for (std::size_t i = 0; i < block.size(); ++i)
      block.set(i, {.state = 0.1F, .last_seen_ms = 0, .observations = 1});
  }
}

void run(const Options& options) {
  const std::vector<Box> boxes = office();
  std::vector<Frame> frames;
  for (int i = 0; i < options.frames; ++i) frames.push_back(see_office(boxes, 10 * i));
  OccupancyParams params;
  apply_settings({{"preset", "corrected"}, {"observed_set", "projected"}, {"max_height_m", "3.5"}},
                 params);
  params.voxel_size_m = options.voxel_m;
  fmt::print("{:>12} {:>10} {:>12} {:>12} {:>12} {:>14}\n", "voxels", "MB", "cpu ms", "changes us",
             "memory us", "look-up ns");
  for (const double voxels : options.voxels) {
    VoxelMap map(options.voxel_m);
    fill(map, voxels);
    std::vector<double> integrate_ms, changes_ms, memory_ms;
    constexpr std::int64_t kFrame_ns = 200'000'000;
    for (const Frame& frame : frames) {
      const ChangeStamp stamp = map.change_stamp();
      const double begin = cpu_ms();
      integrate(frame.clean, camera(), frame.T_world_camera, frame.number * kFrame_ns, params, 1,
                map);
      const double integrated = cpu_ms();
      if (map.blocks_changed_since(stamp).empty()) fmt::print("nothing changed\n");
      const double asked = cpu_ms();
      if (map.memory_bytes() == 0) fmt::print("no memory\n");
      integrate_ms.push_back(integrated - begin);
      changes_ms.push_back(asked - integrated);
      memory_ms.push_back(cpu_ms() - asked);
    }
    constexpr int kQueries = 1'000'000;
    const double begin = cpu_ms();
    std::int64_t known = 0;
    for (int i = 0; i < kQueries; ++i)
      known += map.at({i * 7 % 320, i * 13 % 240, i * 3 % 56}).observations;
    const double look_up_ms = cpu_ms() - begin;
    if (known == 0) fmt::print("nothing known\n");
    fmt::print("{:>12} {:>10.1f} {:>12.1f} {:>12.1f} {:>12.1f} {:>14.1f}\n",
               map.known_voxel_count(), static_cast<double>(map.memory_bytes()) / 1e6,
               median(integrate_ms), median(changes_ms) * 1e3, median(memory_ms) * 1e3,
               look_up_ms * 1e6 / kQueries);
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace stereovox::bench

int main(int argc, char** argv) {
  stereovox::bench::Options options;
  CLI::App app("what a frame costs in maps of different sizes");
  app.add_option("--voxels", options.voxels);
  app.add_option("--frames", options.frames);
  app.add_option("--voxel", options.voxel_m);
  CLI11_PARSE(app, argc, argv);
  stereovox::bench::run(options);
  return 0;
}
