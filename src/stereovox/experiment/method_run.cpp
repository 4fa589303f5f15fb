#include "stereovox/experiment/method_run.h"

#include "stereovox/evaluation/value_grid.h"
#include "stereovox/navmap/project_to_2d.h"
#include "stereovox/occupancy/integrate.h"
#include "stereovox/pipeline/stage_times.h"

namespace stereovox {
namespace {

// The floor of simulated worlds.
constexpr double kFloor_m = 0.0;

template <class... Functions>
struct Overloaded : Functions... {
  using Functions::operator()...;
};

}  // namespace

std::variant<MethodRun::Voxels, OctomapBaseline, MethodRun::Scans> MethodRun::start(
    const MappingMethod& method, double cell_size_m, const HeightBand& band) {
  using State = std::variant<Voxels, OctomapBaseline, Scans>;
  return std::visit(
      Overloaded{
          [&](OccupancyMethod params) -> State {
            params.occupancy.voxel_size_m = cell_size_m;
            params.navmap.min_height_m = band.min_m;
            params.navmap.max_height_m = band.max_m;
            return Voxels{params, VoxelMap(cell_size_m, kFloor_m), SightLines{}, WallFaces{}};
          },
          [&](OctomapBaselineParams params) -> State {
            params.voxel_size_m = cell_size_m;
            // It takes each voxel that touches its band; ours counts by centres.
            params.min_height_m = band.min_m + cell_size_m / 2;
            params.max_height_m = band.max_m - cell_size_m / 2;
            return OctomapBaseline(params);
          },
          [](const auto& params) -> State { return Scans{params}; }},
      method);
}

MethodRun::MethodRun(const MappingMethod& method, double cell_size_m, const HeightBand& band)
    : state_(start(method, cell_size_m, band)) {}

void MethodRun::add(const MethodFrame& frame) {
  Duration duration;
  timed(duration, [&] {
    std::visit(Overloaded{[&](Voxels& v) {
                            const FrameUpdate update =
                                integrate(frame.disparity, frame.camera, frame.T_world_camera,
                                          frame.stamp_ns, v.method.occupancy, 1, v.map);
                            v.sight_lines.observe(v.map, frame.T_world_camera.translation.head<2>(),
                                                  update.hits, v.method.navmap);
                            if (v.method.navmap.uses_faces())
                              v.wall_faces.observe(
                                  view_frame(frame.disparity, frame.camera, frame.T_world_camera,
                                             frame.stamp_ns, v.method.occupancy, v.map),
                                  v.map.floor, v.method.navmap);
                          },
                          [&](OctomapBaseline& tree) {
                            tree.integrate(frame.disparity, frame.camera, frame.T_world_camera);
                          },
                          [](Scans&) {}},
               state_);
    return 0;
  });
  map_ms_ += duration.wall_ms;
}

OccupancyGrid2D MethodRun::map(std::span<const PseudoScan> scans,
                               const GridGeometry& geometry) const {
  Duration duration;
  OccupancyGrid2D map = timed(duration, [&] {
    return std::visit(
        Overloaded{[&](const Voxels& v) {
                     return extended_to(
                         project_to_2d(v.map, v.sight_lines, v.method.navmap, v.wall_faces),
                         geometry);
                   },
                   [&](const OctomapBaseline& tree) { return tree.map(geometry, kFloor_m); },
                   [&](const Scans& s) { return build_map(scans, geometry, s.paradigm); }},
        state_);
  });
  map_ms_ += duration.wall_ms;
  return map;
}

bool MethodRun::needs_scans() const { return std::holds_alternative<Scans>(state_); }

const VoxelMap* MethodRun::voxels() const {
  const Voxels* v = std::get_if<Voxels>(&state_);
  return v == nullptr ? nullptr : &v->map;
}

}  // namespace stereovox
