#include "stereovox/pipeline/map_builder.h"

#include <algorithm>

#include "stereovox/occupancy/integrate.h"
#include "stereovox/stereo/ground_plane.h"

namespace stereovox {

MapBuilder::MapBuilder(const RectifiedCamera& camera, const PipelineConfig& config,
                       bool has_given_poses, const std::filesystem::path& store_folder)
    : camera_(camera),
      config_(config),
      has_given_poses_(has_given_poses),
      store_folder_(store_folder),
      limits_memory_(config.memory_limit_mb > 0.0) {}

void MapBuilder::add(LocatedFrame frame, StageTimes& times) {
  const int id = frame.segment;
  GrowingSegment& segment = segments_[id];
  if (segment.placed) {
    map(frame, *segment.placed, times);
    return;
  }
  segment.waiting.push_back(std::move(frame));
  if (static_cast<int>(segment.waiting.size()) >= config_.world.frames) place(id, segment, times);
}

std::vector<MapSegment> MapBuilder::finish(StageTimes& times, std::vector<std::string>& warnings) {
  limits_memory_ = false;  // what is left to do is little, and must not fail for want of a disk
  std::vector<MapSegment> finished;
  for (auto& [id, segment] : segments_) {
    if (!segment.placed && !segment.waiting.empty()) place(id, segment, times);
    if (!segment.placed) continue;
    for (const std::string& loss : segment.placed->map.forget_unreadable_tiles())
      warnings.push_back(loss);
    if (segment.placed->world.is_assumed)
      warnings.push_back("heights, and so the navigation map, may be wrong: " +
                         segment.placed->world.source);
    finished.push_back(std::move(*segment.placed));
  }
  if (finished.empty()) finished.push_back(empty_segment(0, WorldFrame{}));
  std::ranges::stable_sort(finished, std::ranges::greater{},
                           [](const MapSegment& s) { return s.trajectory.size(); });
  return finished;
}

std::size_t MapBuilder::block_count(int segment) const {
  const auto found = segments_.find(segment);
  return found != segments_.end() && found->second.placed ? found->second.placed->map.block_count()
                                                          : 0;
}

void MapBuilder::place(int id, GrowingSegment& segment, StageTimes& times) {
  std::vector<GroundView> views;
  for (const LocatedFrame& frame : segment.waiting)
    views.push_back({frame.T_segment_camera,
                     estimate_ground_plane(frame.disparity, camera_, config_.world.ground_plane)});
  const WorldFrame world = has_given_poses_ ? world_of_given_poses(views, config_.world)
                                            : world_of_odometry(views, config_.world, id == 0);
  segment.placed = empty_segment(id, world);
  for (const LocatedFrame& frame : segment.waiting) map(frame, *segment.placed, times);
  segment.waiting.clear();
}

MapSegment MapBuilder::empty_segment(int id, const WorldFrame& world) const {
  MapSegment segment{
      id,           world,       VoxelMap(config_.occupancy.voxel_size_m, world.floor_z_m),
      SightLines{}, WallFaces{}, Trajectory{}};
  if (limits_memory_) segment.map.use_store(store_folder_);
  return segment;
}

// The maps of other segments go out first: nobody looks at them.
void MapBuilder::keep_within_memory(MapSegment& current) {
  if (!limits_memory_) return;
  constexpr double kBytesPerMb = 1e6;
  const auto limit = static_cast<std::size_t>(config_.memory_limit_mb * kBytesPerMb);
  std::size_t others = 0;
  for (auto& [id, segment] : segments_) {
    if (!segment.placed || &*segment.placed == &current) continue;
    segment.placed->map.keep_within(limit - std::min(limit, current.map.memory_bytes()));
    others += segment.placed->map.memory_bytes();
  }
  current.map.keep_within(limit - std::min(limit, others));
}

void MapBuilder::map(const LocatedFrame& frame, MapSegment& segment, StageTimes& times) {
  const SE3 T_world_camera = segment.world.T_world_segment * frame.T_segment_camera;
  Duration occupancy;
  const FrameUpdate update = timed(occupancy, [&] {
    return integrate(frame.disparity, camera_, T_world_camera, frame.stamp_ns, config_.occupancy,
                     config_.thread_count(), segment.map);
  });
  const Stopwatch watch;
  segment.sight_lines.observe(segment.map, T_world_camera.translation.head<2>(), update.hits,
                              config_.navmap);
  if (config_.navmap.uses_faces())
    segment.wall_faces.observe(view_frame(frame.disparity, camera_, T_world_camera, frame.stamp_ns,
                                          config_.occupancy, segment.map),
                               segment.map.floor, config_.navmap);
  times.add("occupancy", occupancy);
  times.add("navmap", watch.elapsed());
  segment.trajectory.push_back({frame.stamp_ns, T_world_camera});
  keep_within_memory(segment);
}

}  // namespace stereovox
