// The map engine beside OctoMap and, where it is installed, OpenVDB: the same frames of the same
// scene through all of them, in one run.
//
//   map_engine [--frames N] [--step N] [--voxel M] [--pixels N] [--threads N] [--depth clean|noisy]
//              [--only NAME] [--no-accuracy] [--seed N] [--set occupancy parameter=value]...
//
// Without options: 5 and 10 cm, all pixels and every fourth, one and two threads, clean and noisy
// depth. CPU time counts all threads; the machine may do other work, so compare CPU times.
#include <fmt/format.h>
#include <octomap/octomap.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "map_engine_openvdb.h"
#include "stereovox/core/grid_geometry.h"
#include "stereovox/occupancy/frame_view.h"
#include "stereovox/occupancy/integrate.h"
#include "stereovox/occupancy/map_queries.h"

namespace stereovox::bench {
namespace {

struct Options {
  int frames = 20, step = 10;  // of the drive, every `step`-th
  std::vector<double> voxels_m = {0.05, 0.1};
  std::vector<int> pixel_steps = {1, 4}, threads = {1, 2};
  std::vector<std::string> depths = {"clean", "noisy"};
  std::vector<std::string> only;
  std::vector<std::string> settings;
  std::uint64_t seed = 0;  // of the noise
  bool has_truth = true;   // without, no accuracy is measured
};

void print(const Case& c, const Result& r, double octomap_ms) {
  const double cpu_ms = median(r.times.cpu_ms);
  fmt::print(
      "{:>4.0f} {:>5} {:>6} {:>3} {:<18} {:>8.1f} {:>8.1f} {:>8.1f} {:>7.1f} {:>6.1f} {:>6.0f} "
      "{:>6.0f} {:>6.2f}  {:.3f} {:.3f} {:.3f} {:.3f} {:.3f}\n",
      c.voxel_size_m * 1e2, c.pixel_step, c.depth == Depth::clean ? "clean" : "noisy", c.threads,
      r.name, cpu_ms, quantile(r.times.cpu_ms, 0.95), median(r.times.wall_ms), octomap_ms / cpu_ms,
      r.bytes_per_voxel, r.look_up_ns, r.batch_ns, r.ray_us, r.accuracy.free_recall,
      r.accuracy.occupied_recall, r.accuracy.near_recall, r.accuracy.thin_recall,
      r.accuracy.precision);
  std::fflush(stdout);
}

void print_header() {
  fmt::print("{:>4} {:>5} {:>6} {:>3} {:<18} {:>8} {:>8} {:>8} {:>7} {:>6} {:>6} {:>6} {:>6}  {}\n",
             "cm", "px", "depth", "thr", "engine", "cpu ms", "p95", "wall ms", "OctoMap", "B/vox",
             "ns", "batch", "ray us", "free  occ   near  thin  precision");
}

octomap::Pointcloud points_of(const Frame& frame, const Case& c) {
  const cv::Mat1f& disparity = frame.seen(c.depth).disparity_px;
  octomap::Pointcloud points;
  for (int v = first_sample(c.pixel_step); v < disparity.rows; v += c.pixel_step)
    for (int u = first_sample(c.pixel_step); u < disparity.cols; u += c.pixel_step) {
      if (disparity(v, u) == 0.0F) continue;
      const Eigen::Vector3f p =
          (frame.T_world_camera * triangulate(camera(), u, v, double(disparity(v, u))))
              .cast<float>();
      points.push_back(p.x(), p.y(), p.z());
    }
  return points;
}

octomap::point3d octomap_point(const Eigen::Vector3d& p) {
  return {float(p.x()), float(p.y()), float(p.z())};
}

Result run_octomap(const Case& c, const std::vector<Frame>& frames, const Truth& truth) {
  octomap::OcTree tree(c.voxel_size_m);
  Result result{.name = "OctoMap", .times = {}, .accuracy = {}};
  for (const Frame& frame : frames) {
    const octomap::Pointcloud points = points_of(frame, c);
    const octomap::point3d origin = octomap_point(frame.T_world_camera.translation);
    time(result.times, [&] { tree.insertPointCloud(points, origin); });
  }
  const auto state_at = [&](const Eigen::Vector3d& p) {
    const octomap::OcTreeNode* const node = tree.search(p.x(), p.y(), p.z());
    if (node == nullptr) return State::unknown;
    return tree.isNodeOccupied(node) ? State::occupied : State::free;
  };
  std::int64_t known = 0;
  const auto voxel_state = [&](const Eigen::Vector3i& voxel) {
    return state_at(voxel_center_of(c.voxel_size_m, voxel));
  };
  result.accuracy = accuracy_of(truth, voxel_state);
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    const auto side = static_cast<std::int64_t>(std::lround(leaf.getSize() / c.voxel_size_m));
    known += side * side * side;
  }
  result.bytes_per_voxel = static_cast<double>(tree.memoryUsage()) / static_cast<double>(known);
  result.look_up_ns = look_up_ns(state_at);
  result.ray_us = ray_us(frames, [&](const Eigen::Vector3d& from, const Eigen::Vector3d& way) {
    octomap::point3d end;
    return tree.castRay(octomap_point(from), octomap_point(way), end, true, kMaxRange_m);
  });
  return result;
}

Result run_ours(const std::string& name, OccupancyParams params, const Case& c,
                const std::vector<Frame>& frames, const Truth& truth) {
  params.voxel_size_m = c.voxel_size_m;
  params.pixel_step = params.ray_step_px = c.pixel_step;
  VoxelMap map(c.voxel_size_m);
  Result result{.name = name, .times = {}, .accuracy = {}};
  constexpr std::int64_t kFrame_ns = 200'000'000;
  for (const Frame& frame : frames)
    time(result.times, [&] {
      integrate(frame.seen(c.depth), camera(), frame.T_world_camera, frame.number * kFrame_ns,
                params, c.threads, map);
    });
  const MapQueries queries(map);
  result.accuracy = accuracy_of(
      truth, [&](const Eigen::Vector3i& voxel) { return queries.state_of(map.packed_at(voxel)); });
  result.bytes_per_voxel =
      static_cast<double>(map.memory_bytes()) / static_cast<double>(map.known_voxel_count());
  result.ray_us = ray_us(frames, [&](const Eigen::Vector3d& from, const Eigen::Vector3d& way) {
    return queries.cast_ray(from, way, kMaxRange_m).has_value();
  });
  result.look_up_ns = look_up_ns([&](const Eigen::Vector3d& p) { return queries.state_at(p); });
  result.batch_ns =
      batch_ns([&](std::span<const Eigen::Vector3d> places) { return queries.states_at(places); });
  return result;
}

// The limits of the scene: everything within the range of the frames counts.
Settings scene_limits() {
  return {{"max_depth_m", "8"},
          {"max_clearing_m", "8"},
          {"min_height_m", "-1"},
          {"max_height_m", "3.5"}};
}

// The model of OctoMap in this engine: the voxel that holds an end point is hit, whatever its
// error, the voxels that rays cross are free.
Settings log_odds_settings() {
  return {{"observation.type", "point"},   {"union.type", "rank"},
          {"union.quantile", "0"},         {"density.lambda", "0"},
          {"update.type", "log_odds"},     {"free_margin_sigmas", "0"},
          {"max_sigma_half_voxels", "30"}, {"observed_set", "projected"}};
}

struct Engine {
  std::string name;
  Settings settings;
};

std::vector<Engine> engines() {
  return {{"log_odds", log_odds_settings()},
          {"corrected", {{"preset", "corrected"}, {"observed_set", "projected"}}},
          {"tuned", {{"preset", "tuned"}, {"observed_set", "projected"}}}};
}

Settings parsed(const std::vector<std::string>& words) {
  Settings settings;
  for (const std::string& word : words)
    settings.emplace_back(word.substr(0, word.find('=')), word.substr(word.find('=') + 1));
  return settings;
}

void run_case(const Options& options, const Case& c, const std::vector<Frame>& frames,
              const Truth& truth) {
  const auto is_wanted = [&](const std::string& name) {
    return options.only.empty() || std::ranges::count(options.only, name) > 0;
  };
  double octomap_ms = 0.0;
  if (is_wanted("OctoMap")) {
    const Result octomap = run_octomap(c, frames, truth);
    octomap_ms = median(octomap.times.cpu_ms);
    print(c, octomap, octomap_ms);
  }
  if (has_openvdb_peer() && is_wanted("OpenVDB"))
    print(c, run_openvdb(c, frames, truth), octomap_ms);
  for (const auto& [name, settings] : engines()) {
    if (!is_wanted(name)) continue;
    OccupancyParams params;
    apply_settings(settings, params);
    apply_settings(scene_limits(), params);
    apply_settings(parsed(options.settings), params);
    print(c, run_ours(name, params, c, frames, truth), octomap_ms);
  }
}

Options parse(int argc, char** argv) {
  Options options;
  CLI::App app("the map engine beside OctoMap");
  app.add_option("--frames", options.frames);
  app.add_option("--step", options.step);
  app.add_option("--voxel", options.voxels_m);
  app.add_option("--pixels", options.pixel_steps);
  app.add_option("--threads", options.threads);
  app.add_option("--depth", options.depths);
  app.add_option("--only", options.only);
  app.add_option("--set", options.settings);
  app.add_option("--seed", options.seed);
  app.add_flag("!--no-accuracy", options.has_truth);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::exit(app.exit(error));
  }
  return options;
}

void run(const Options& options) {
  const std::vector<Box> boxes = office();
  std::vector<Frame> frames;
  for (int i = 0; i < options.frames; ++i)
    frames.push_back(see_office(boxes, i * options.step, options.seed));
  print_header();
  for (const double voxel_m : options.voxels_m) {
    const Truth truth = truth_of(boxes, options.has_truth ? frames : std::vector<Frame>{}, voxel_m);
    for (const std::string& depth : options.depths)
      for (const int pixel_step : options.pixel_steps)
        for (const int threads : options.threads)
          run_case(options,
                   {voxel_m, pixel_step, threads, depth == "clean" ? Depth::clean : Depth::noisy},
                   frames, truth);
  }
}

}  // namespace
}  // namespace stereovox::bench

int main(int argc, char** argv) {
  stereovox::bench::run(stereovox::bench::parse(argc, argv));
  return 0;
}
