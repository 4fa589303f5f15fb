#include "stereovox/pipeline/map_builder.h"

#include <fmt/format.h>

#include <algorithm>

#include "stereovox/occupancy/integrate.h"
#include "stereovox/stereo/ground_plane.h"

namespace stereovox {
namespace {

// A given pose this near in time is the frame's own.
constexpr std::int64_t kPoseTolerance_ns = 1'000'000;
// Between given poses farther apart than this nothing is interpolated.
constexpr std::int64_t kMaxPoseGap_ns = 250'000'000;

}  // namespace

MapBuilder::MapBuilder(const Rectifier& rectifier, const PipelineConfig& config,
                       const std::optional<Trajectory>& given_poses,
                       const std::filesystem::path& store_folder)
    : rectifier_(rectifier),
      config_(config),
      given_poses_(given_poses),
      store_folder_(store_folder),
      odometry_(rectifier.camera(), config.odometry),
      limits_memory_(config.memory_limit_mb > 0.0) {
  result_.camera = rectifier.camera();
}

Progress MapBuilder::add(MatchedFrame frame) {
  result_.times.add("rectify", frame.rectify);
  result_.times.add("disparity", frame.match);
  Duration odometry, occupancy;
  const OdometryResult motion = timed(odometry, [&] { return locate(frame); });
  result_.times.add("odometry", odometry);
  ++result_.frames;

  Progress progress;
  progress.match_ms = frame.match.wall_ms;
  progress.odometry_ms = odometry.wall_ms;
  progress.inliers = motion.inliers;
  progress.is_tracked = motion.status == OdometryStatus::tracked;
  if (progress.is_tracked) {
    ++result_.tracked;
    is_lost_ = false;
    const Stopwatch watch;
    add_to_segment(motion.segment, {std::move(frame), motion.T_segment_camera});
    progress.occupancy_ms = watch.elapsed().wall_ms;
  } else {
    note_lost(frame, motion.reason);
  }
  if (const auto& segment = segments_[motion.segment].placed)
    progress.voxel_blocks = segment->map.block_count();
  return progress;
}

BuildResult MapBuilder::finish() {
  limits_memory_ = false;  // what is left to do is little, and must not fail for want of a disk
  for (auto& [id, segment] : segments_) {
    if (!segment.placed && !segment.waiting.empty()) place(id, segment);
    if (!segment.placed) continue;
    for (const std::string& loss : segment.placed->map.forget_unreadable_tiles())
      result_.warnings.push_back(loss);
    result_.segments.push_back(std::move(*segment.placed));
  }
  if (result_.segments.empty()) result_.segments.push_back(empty_segment(0, WorldFrame{}));
  std::ranges::stable_sort(result_.segments, std::ranges::greater{},
                           [](const MapSegment& s) { return s.trajectory.size(); });
  return std::move(result_);
}

OdometryResult MapBuilder::locate(const MatchedFrame& frame) {
  return given_poses_ ? locate_by_given_poses(frame.pair.stamp_ns)
                      : odometry_.track(frame.pair, frame.disparity);
}

OdometryResult MapBuilder::locate_by_given_poses(std::int64_t stamp_ns) const {
  OdometryResult result{};
  const std::optional<SE3> T_world_left =
      pose_at(*given_poses_, stamp_ns, kPoseTolerance_ns, kMaxPoseGap_ns);
  result.status = T_world_left ? OdometryStatus::tracked : OdometryStatus::lost;
  if (T_world_left) result.T_segment_camera = *T_world_left * rectifier_.T_left_rectified();
  if (!T_world_left) result.reason = "no pose is given for this time";
  return result;
}

void MapBuilder::note_lost(const MatchedFrame& frame, const std::string& reason) {
  const std::int64_t stamp_ns = frame.pair.stamp_ns;
  if (!is_lost_) result_.lost.push_back({stamp_ns, stamp_ns, 0, reason});
  is_lost_ = true;
  result_.lost.back().to_ns = stamp_ns;
  ++result_.lost.back().frames;
}

void MapBuilder::add_to_segment(int id, Located located) {
  GrowingSegment& segment = segments_[id];
  if (segment.placed) {
    map(located, *segment.placed);
    return;
  }
  segment.waiting.push_back(std::move(located));
  if (static_cast<int>(segment.waiting.size()) >= config_.world.frames) place(id, segment);
}

void MapBuilder::place(int id, GrowingSegment& segment) {
  std::vector<GroundView> views;
  for (const Located& located : segment.waiting)
    views.push_back({located.T_segment_camera,
                     estimate_ground_plane(located.frame.disparity, rectifier_.camera(),
                                           config_.world.ground_plane)});
  const WorldFrame world = given_poses_ ? world_of_given_poses(views, config_.world)
                                        : world_of_odometry(views, config_.world, id == 0);
  segment.placed = empty_segment(id, world);
  for (const Located& located : segment.waiting) map(located, *segment.placed);
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

void MapBuilder::map(const Located& located, MapSegment& segment) {
  const std::int64_t stamp_ns = located.frame.pair.stamp_ns;
  const SE3 T_world_camera = segment.world.T_world_segment * located.T_segment_camera;
  Duration occupancy, navmap;
  const FrameUpdate update = timed(occupancy, [&] {
    return integrate(located.frame.disparity, rectifier_.camera(), T_world_camera, stamp_ns,
                     config_.occupancy, config_.thread_count(), segment.map);
  });
  const Stopwatch watch;
  segment.sight_lines.observe(segment.map, T_world_camera.translation.head<2>(), update.hits,
                              config_.navmap);
  if (config_.navmap.uses_faces())
    segment.wall_faces.observe(view_frame(located.frame.disparity, rectifier_.camera(),
                                          T_world_camera, stamp_ns, config_.occupancy, segment.map),
                               segment.map.floor_z_m(), config_.navmap);
  result_.times.add("occupancy", occupancy);
  result_.times.add("navmap", watch.elapsed());
  segment.trajectory.push_back({stamp_ns, T_world_camera});
  keep_within_memory(segment);
}

}  // namespace stereovox
