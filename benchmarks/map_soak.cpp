// A soak: a long drive through a row of offices, once without limit and once with a tile store that
// forces the map into a tenth of its memory. Both maps must be the same bytes, and the memory of
// the second must not grow. Exit status 1 when either fails.
//
//   map_soak [--frames N] [--offices N] [--voxel M] [--threads N] [--share S]
#include <fmt/format.h>
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <fstream>

#include "map_engine_world.h"
#include "stereovox/occupancy/integrate.h"
#include "stereovox/occupancy/voxel_map_file.h"

namespace stereovox::bench {
namespace {

namespace fs = std::filesystem;

struct Options {
  int frames = 2000, offices = 20, threads = 2;
  double voxel_m = 0.1, share = 0.1;
};

// One pass through the office, seen again in each office of the row.
constexpr int kViews = 50, kStep = 2;
constexpr double kOfficeLength_m = 16.0;

struct Soak {
  std::size_t peak_bytes = 0, tiles_out = 0;
  std::vector<std::size_t> bytes_by_tenth;  // largest in each tenth of the drive
  double wall_s = 0.0;
};

// The drive goes along the row and back, so that what went out comes back.
SE3 pose_in_row(const Frame& frame, int office) {
  SE3 pose = frame.T_world_camera;
  pose.translation.x() += kOfficeLength_m * office;
  return pose;
}

Soak drive(const Options& options, const std::vector<Frame>& views,
           std::optional<std::size_t> limit_bytes, const fs::path& output) {
  OccupancyParams params;
  apply_settings({{"preset", "corrected"},
                  {"observed_set", "projected"},
                  {"pixel_step", "4"},
                  {"ray_step_px", "4"},
                  {"max_height_m", "3.5"}},
                 params);
  params.voxel_size_m = options.voxel_m;
  VoxelMap map(options.voxel_m);
  map.use_store(output.parent_path());
  Soak soak;
  soak.bytes_by_tenth.resize(10);
  constexpr std::int64_t kFrame_ns = 200'000'000;
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < options.frames; ++i) {
    const int way = std::min(i, options.frames - 1 - i) * 2 * options.offices / options.frames;
    const Frame& view = views[static_cast<std::size_t>(i % kViews)];
    integrate(view.seen(Depth::noisy), camera(), pose_in_row(view, way), i * kFrame_ns, params,
              options.threads, map);
    if (limit_bytes) map.keep_within(*limit_bytes);
    std::size_t& most = soak.bytes_by_tenth[static_cast<std::size_t>(10 * i / options.frames)];
    most = std::max(most, map.memory_bytes());
    soak.peak_bytes = std::max(soak.peak_bytes, map.memory_bytes());
    soak.tiles_out = std::max(soak.tiles_out, map.tiles_out());
  }
  soak.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  write_voxel_map(output, map);
  return soak;
}

void print(const char* name, const Soak& soak) {
  constexpr double kBytesPerMb = 1e6;
  fmt::print("{:<10} {:>7.1f} s, peak {:>7.1f} MB, {:>5} tiles out; MB by tenth of the drive:",
             name, soak.wall_s, static_cast<double>(soak.peak_bytes) / kBytesPerMb, soak.tiles_out);
  for (const std::size_t bytes : soak.bytes_by_tenth)
    fmt::print(" {:.1f}", static_cast<double>(bytes) / kBytesPerMb);
  fmt::print("\n");
  std::fflush(stdout);
}

bool are_equal(const fs::path& a, const fs::path& b) {
  std::ifstream first(a, std::ios::binary), second(b, std::ios::binary);
  return fs::file_size(a) == fs::file_size(b) &&
         std::equal(std::istreambuf_iterator<char>(first), std::istreambuf_iterator<char>(),
                    std::istreambuf_iterator<char>(second));
}

int run(const Options& options) {
  const fs::path folder = fs::temp_directory_path() / fmt::format("map_soak_{}", ::getpid());
  fs::create_directory(folder);
  const std::vector<Box> boxes = office();
  std::vector<Frame> views;
  for (int i = 0; i < kViews; ++i) views.push_back(see_office(boxes, kStep * i));

  const Soak all = drive(options, views, std::nullopt, folder / "all.svx");
  print("unlimited", all);
  const auto limit = static_cast<std::size_t>(options.share * static_cast<double>(all.peak_bytes));
  const Soak limited = drive(options, views, limit, folder / "limited.svx");
  print("limited", limited);
  const bool same = are_equal(folder / "all.svx", folder / "limited.svx");
  fmt::print("maps of {} bytes are {}\n", fs::file_size(folder / "all.svx"),
             same ? "the same" : "DIFFERENT");
  fs::remove_all(folder);
  return same && limited.peak_bytes <= limit ? 0 : 1;
}

}  // namespace
}  // namespace stereovox::bench

int main(int argc, char** argv) {
  stereovox::bench::Options options;
  CLI::App app("a long drive in a tenth of the memory");
  app.add_option("--frames", options.frames);
  app.add_option("--offices", options.offices);
  app.add_option("--voxel", options.voxel_m);
  app.add_option("--threads", options.threads);
  app.add_option("--share", options.share);
  CLI11_PARSE(app, argc, argv);
  return stereovox::bench::run(options);
}
