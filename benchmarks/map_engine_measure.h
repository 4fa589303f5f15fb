// What the map engine's benchmark measures of a map, whoever made it.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "map_engine_world.h"
#include "stereovox/occupancy/map_queries.h"
#include "timing.h"

namespace stereovox::bench {

using State = VoxelState;
using StateAt = std::function<State(const Eigen::Vector3i&)>;

struct Case {
  double voxel_size_m = 0.05;
  int pixel_step = 1, threads = 1;
  Depth depth = Depth::clean;
};

// Free recall: of the voxels without a solid that a ray crossed. Occupied recall: of the voxels
// that hold the end of a ray; `near` counts an occupied voxel among the 26 around. Precision: of
// the occupied voxels those that, grown by half a voxel, touch a solid.
struct Accuracy {
  double free_recall = 0, occupied_recall = 0, near_recall = 0, thin_recall = 0, precision = 0;
};

Accuracy accuracy_of(const Truth& truth, const StateAt& state);

struct Result {
  std::string name;
  Times times;
  double bytes_per_voxel = 0, look_up_ns = 0, ray_us = 0;
  double batch_ns = 0;  // of a look-up among many asked at once; 0 = the engine has no such call
  Accuracy accuracy;
};

// The compiler must not drop the loop that counted this.
void keep(std::int64_t count);

// Where queries are asked: scattered over the office.
std::vector<Eigen::Vector3d> random_places(int count);

template <class LookUp>
double look_up_ns(LookUp look_up) {
  constexpr int kQueries = 1'000'000;
  constexpr double kNsPerMs = 1e6;
  const std::vector<Eigen::Vector3d> places = random_places(kQueries);
  std::int64_t occupied = 0;
  Times times;
  for (int round = 0; round < 3; ++round)
    time(times, [&] {
      for (const Eigen::Vector3d& p : places) occupied += look_up(p) == State::occupied ? 1 : 0;
    });
  keep(occupied);
  return median(times.cpu_ms) * kNsPerMs / kQueries;
}

// The same places, asked many at a time.
template <class LookUp>
double batch_ns(LookUp look_up) {
  constexpr std::size_t kQueries = 1'000'000, kAtATime = 1000;
  constexpr double kNsPerMs = 1e6;
  const std::vector<Eigen::Vector3d> places = random_places(kQueries);
  std::int64_t occupied = 0;
  Times times;
  for (int round = 0; round < 3; ++round)
    time(times, [&] {
      for (std::size_t i = 0; i < kQueries; i += kAtATime)
        occupied +=
            std::ranges::count(look_up(std::span(places).subspan(i, kAtATime)), State::occupied);
    });
  keep(occupied);
  return median(times.cpu_ms) * kNsPerMs / double(kQueries);
}

// Rays into all directions from where the camera was, up to kMaxRange_m.
template <class Cast>
double ray_us(const std::vector<Frame>& frames, Cast cast) {
  constexpr int kRays = 20'000;
  constexpr double kUsPerMs = 1e3;
  const std::vector<Eigen::Vector3d> targets = random_places(kRays);
  std::int64_t hits = 0;
  Times times;
  for (int round = 0; round < 3; ++round)
    time(times, [&] {
      for (std::size_t i = 0; i < targets.size(); ++i) {
        const Eigen::Vector3d& from = frames[i % frames.size()].T_world_camera.translation;
        hits += cast(from, Eigen::Vector3d((targets[i] - from).normalized())) ? 1 : 0;
      }
    });
  keep(hits);
  return median(times.cpu_ms) * kUsPerMs / kRays;
}

}  // namespace stereovox::bench
