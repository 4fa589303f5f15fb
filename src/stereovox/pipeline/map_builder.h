// The back half of the line: a pose for each matched frame, and the maps that follow from them.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <vector>

#include "stereovox/pipeline/build_maps.h"
#include "stereovox/pipeline/matched_frames.h"

namespace stereovox {

class MapBuilder {
 public:
  MapBuilder(const Rectifier& rectifier, const PipelineConfig& config,
             const std::optional<Trajectory>& given_poses,
             const std::filesystem::path& store_folder);

  // Frames in order of time. Throws ResourceError when the tile store fails; the maps then hold all
  // that is left, and finish() may be called.
  Progress add(MatchedFrame frame);

  // Maps what still waits. Call it once, after the last frame.
  BuildResult finish();

 private:
  struct Located {
    MatchedFrame frame;
    SE3 T_segment_camera;
  };
  // Its first frames wait until the floor is known.
  struct GrowingSegment {
    std::vector<Located> waiting;
    std::optional<MapSegment> placed;
  };

  OdometryResult locate(const MatchedFrame& frame);
  OdometryResult locate_by_given_poses(std::int64_t stamp_ns) const;
  void note_lost(const MatchedFrame& frame, const std::string& reason);
  void add_to_segment(int id, Located located);
  void place(int id, GrowingSegment& segment);
  MapSegment empty_segment(int id, const WorldFrame& world) const;
  void map(const Located& located, MapSegment& segment);
  void keep_within_memory(MapSegment& current);

  const Rectifier& rectifier_;
  const PipelineConfig config_;
  const std::optional<Trajectory>& given_poses_;
  const std::filesystem::path store_folder_;
  Odometry odometry_;
  std::map<int, GrowingSegment> segments_;
  BuildResult result_;
  bool is_lost_ = false, limits_memory_;
};

}  // namespace stereovox
