// Images in, maps out: the whole line.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "stereovox/core/trajectory.h"
#include "stereovox/dataset/stereo_sequence.h"
#include "stereovox/navmap/sight_lines.h"
#include "stereovox/navmap/wall_faces.h"
#include "stereovox/occupancy/voxel_map.h"
#include "stereovox/pipeline/pipeline_config.h"
#include "stereovox/pipeline/stage_times.h"
#include "stereovox/pipeline/world_frame.h"

namespace stereovox {

// What was made of the frames between two losses of tracking, or since a place was recognised
// again: poses of one segment share one world.
struct MapSegment {
  int id = 0;
  WorldFrame world;
  VoxelMap map;
  SightLines sight_lines;
  WallFaces wall_faces;
  Trajectory trajectory;  // T_world_camera of every frame that was mapped
};

// Consecutive frames without a trusted pose; they touched no map.
struct LostStretch {
  std::int64_t from_ns = 0, to_ns = 0;
  int frames = 0;
  std::string reason;  // of the first of them
};

struct BuildResult {
  std::vector<MapSegment> segments;  // most frames first; at least one
  std::vector<LostStretch> lost;
  std::vector<std::string> warnings;
  RectifiedCamera camera;
  StageTimes times;
  int frames = 0, tracked = 0;
  int repeated = 0;  // frames with the images of the one before: they have a pose but tell nothing
  double wall_s = 0.0;
  bool was_stopped = false;
  std::string failure;  // why the map could not grow on: the disk or the memory; empty: it could

  double tracked_percent() const { return frames == 0 ? 0.0 : 100.0 * tracked / frames; }
};

// With refined poses frames are first tracked, all of them, and then mapped; otherwise both at
// once.
enum class RunStage { tracking, mapping };

// The state after a frame.
struct Progress {
  RunStage stage = RunStage::tracking;
  int frame = 0, frames = 0;  // done, in all
  bool is_tracked = false;
  int inliers = 0;
  double elapsed_s = 0.0;                                        // in this stage
  double match_ms = 0.0, odometry_ms = 0.0, occupancy_ms = 0.0;  // of this frame
  std::size_t voxel_blocks = 0;
};

struct ProgressSink {
  std::function<void(const Progress&)> frame_done = [](const Progress&) {};
  std::function<void(const std::string&)> warn = [](const std::string&) {};
  std::function<bool()> should_stop = [] { return false; };  // asked before each frame
};

// With `refine`, disparities wait in a nameless file in `store_folder` until all frames are
// tracked, and with a memory limit so do tiles out of view. When that fails the run ends there and
// `failure` says why; what was mapped is in the result.
//
// Poses come from odometry, or from `given_poses` of the left camera as calibrated; a frame that
// has none there counts as lost. Throws Error for input that cannot be used.
BuildResult build_maps(
    StereoSequence& sequence, const PipelineConfig& config,
    const std::optional<Trajectory>& given_poses, const ProgressSink& progress,
    const std::filesystem::path& store_folder = std::filesystem::temp_directory_path());

}  // namespace stereovox
