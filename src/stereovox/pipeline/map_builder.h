// The back half of the line: the maps that follow from frames whose place is known.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "stereovox/pipeline/build_maps.h"

namespace stereovox {

struct LocatedFrame {
  std::int64_t stamp_ns = 0;
  DisparityImage disparity;
  int segment = 0;
  SE3 T_segment_camera;
};

class MapBuilder {
 public:
  // With `has_given_poses` the frame of the segment is the world of those poses.
  MapBuilder(const RectifiedCamera& camera, const PipelineConfig& config, bool has_given_poses,
             const std::filesystem::path& store_folder);

  // Frames in order of time. Throws ResourceError when the tile store fails; the maps then hold all
  // that is left, and finish() may be called.
  void add(LocatedFrame frame, StageTimes& times);

  // Maps what still waits; most frames first, at least one. What was lost of them is added to the
  // warnings. Call it once, after the last frame.
  std::vector<MapSegment> finish(StageTimes& times, std::vector<std::string>& warnings);

  std::size_t block_count(int segment) const;

 private:
  // Its first frames wait until the floor is known.
  struct GrowingSegment {
    std::vector<LocatedFrame> waiting;
    std::optional<MapSegment> placed;
  };

  void place(int id, GrowingSegment& segment, StageTimes& times);
  MapSegment empty_segment(int id, const WorldFrame& world) const;
  void map(const LocatedFrame& frame, MapSegment& segment, StageTimes& times);
  void keep_within_memory(MapSegment& current);

  const RectifiedCamera camera_;
  const PipelineConfig config_;
  const bool has_given_poses_;
  const std::filesystem::path store_folder_;
  std::map<int, GrowingSegment> segments_;
  bool limits_memory_;
};

}  // namespace stereovox
