// stereovox info SOURCE|MAP|OUT: what it holds, in numbers.
#include <fmt/format.h>

#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "command.h"
#include "stereovox/core/timestamp.h"
#include "stereovox/core/version.h"
#include "stereovox/io/file_bytes.h"
#include "stereovox/io/image_file.h"
#include "stereovox/navmap/draw_map.h"
#include "stereovox/navmap/draw_voxels.h"
#include "stereovox/navmap/read_map_server.h"
#include "stereovox/occupancy/voxel_map_file.h"
#include "stereovox/pipeline/report.h"

namespace stereovox {
namespace {

namespace fs = std::filesystem;

struct InfoOptions {
  std::string what, picture;
  bool parameters = false;
};

constexpr std::uint64_t kMaxReportBytes = 256ULL << 20;

void print_map(const fs::path& path, const std::string& picture) {
  const VoxelMap map = read_voxel_map(path);
  if (!picture.empty()) write_png(picture, draw_voxels(map));
  const MapCounts counts = count_voxels(map, NavmapParams{}.threshold);
  std::cout << fmt::format("{}: voxel map, {} bytes on disk, {:.1f} MB in memory\n", path.string(),
                           fs::file_size(path), static_cast<double>(map.memory_bytes()) / 1e6);
  std::cout << fmt::format("voxels of {} m, floor at z = {:.3f} m, {} frames\n", map.voxel_size_m(),
                           map.floor_z_m(), map.frames_integrated);
  if (const auto [low_m, high_m] = map.floor.z_range_m(); low_m < high_m)
    std::cout << fmt::format("floor seen from z = {:.2f} to {:.2f} m\n", low_m, high_m);
  std::cout << fmt::format("{} observed: {} occupied, {} free\n", counts.observed, counts.occupied,
                           counts.free);
  if (const auto bounds = map.bounds()) {
    const Eigen::Vector3d low = bounds->min.cast<double>() * map.voxel_size_m();
    const Eigen::Vector3d high =
        (bounds->max.array() + 1).matrix().cast<double>() * map.voxel_size_m();
    std::cout << fmt::format("x {:.2f} .. {:.2f} m, y {:.2f} .. {:.2f} m, z {:.2f} .. {:.2f} m\n",
                             low.x(), high.x(), low.y(), high.y(), low.z(), high.z());
  }
  for (const auto& [name, blob] : map.attachments)
    std::cout << fmt::format("attached: {}, {} bytes\n", name, blob.size());
}

void print_navigation_map(const fs::path& path, const std::string& picture) {
  const LoadedMap loaded = read_map_server(path);
  if (!picture.empty()) write_png(picture, draw_map(loaded.grid, {}));
  const GridGeometry& grid = loaded.grid.geometry;
  std::cout << fmt::format("{}: navigation map, {} x {} cells of {} m from ({}, {}) m\n",
                           path.string(), grid.width, grid.height, grid.cell_size_m,
                           grid.origin_m.x(), grid.origin_m.y());
}

void print_run(const fs::path& folder, const std::string& picture) {
  if (!picture.empty()) write_png(picture, draw_voxels(read_voxel_map(folder / "map.svx")));
  const fs::path path = folder / "report.json";
  const auto report =
      nlohmann::ordered_json::parse(read_file(path, kMaxReportBytes), nullptr, false);
  if (report.is_discarded()) throw Error(path.string() + ": is not JSON");
  std::cout << folder.string() << ": results of a run\n" << report.dump(2) << "\n";
}

void print_source(const fs::path& path) {
  const auto sequence = open_sequence(path, SequenceParams{}, std::nullopt);
  const SequenceInfo& info = sequence->info();
  const PinholeCamera& c = sequence->rig().left.pinhole;
  std::cout << fmt::format("{}: {}, {} pairs\n", path.string(), info.layout, info.pairs);
  std::cout << fmt::format(
      "{} x {}, fx {:.3f} fy {:.3f} cx {:.3f} cy {:.3f} px, baseline {:.4f} m, {}\n", c.width,
      c.height, c.fx_px, c.fy_px, c.cx_px, c.cy_px, sequence->rig().baseline_m(),
      sequence->rig().is_rectified ? "rectified" : "not rectified");
  std::cout << fmt::format("left only {}, right only {}, duplicates {}, gaps {}\n", info.left_only,
                           info.right_only, info.duplicates, info.gaps);
  const Trajectory& truth = sequence->truth();
  if (!truth.empty())
    std::cout << fmt::format("{} true poses over {:.3f} s, {:.2f} m\n", truth.size(),
                             seconds_from_ns(truth.back().stamp_ns - truth.front().stamp_ns),
                             path_length_m(truth));
}

ExitCode run(const InfoOptions& options) {
  if (options.parameters) {
    std::cout << parameters_page();
    return ExitCode::ok;
  }
  if (options.what.empty()) {
    std::cout << "stereovox " << version() << "\n";
    return ExitCode::ok;
  }
  const fs::path path = options.what;
  require_output(options.picture, {path, fs::path(path).replace_extension(".pgm")});
  if (path.extension() == ".svx")
    print_map(path, options.picture);
  else if (path.extension() == ".yaml")
    print_navigation_map(path, options.picture);
  else if (fs::exists(path / "report.json"))
    print_run(path, options.picture);
  else if (!options.picture.empty())
    throw UsageError(path.string() + ": --picture draws maps, and this is none");
  else
    print_source(path);
  return ExitCode::ok;
}

}  // namespace

void add_info(CLI::App& program, Action& action) {
  auto options = std::make_shared<InfoOptions>();
  CLI::App* command = program.add_subcommand("info", "what a data set, a map or a run holds");
  command->add_option("WHAT", options->what, "data set, map.svx, nav.yaml or the folder of a run");
  command
      ->add_option("--picture", options->picture,
                   "draw the map: voxels in colour by height (of a run, too), or cells")
      ->type_name("FILE.png");
  command->add_flag("--parameters", options->parameters, "print the page of all parameters");
  command->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace stereovox
