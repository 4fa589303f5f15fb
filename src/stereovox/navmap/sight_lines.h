// The part of the labelling that happens frame by frame (method.md, "Threshold and labels"): which
// cells lay on a line of sight from the robot, and, with hysteresis, which cells were occupied.
//
//   SightLines sight_lines;
//   for each frame: { integrate(...); sight_lines.observe(map, robot_xy, update.hits, params); }
//   map.attachments[kSightLinesAttachment] = to_bytes(sight_lines);
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "stereovox/core/se3.h"
#include "stereovox/navmap/cell_set.h"
#include "stereovox/navmap/column_states.h"
#include "stereovox/navmap/navmap_params.h"
#include "stereovox/occupancy/voxel_map.h"

namespace stereovox {

inline constexpr const char* kSightLinesAttachment = "sight_lines";

class SightLines {
 public:
  // To be called after each frame. `hits` are the voxels the frame hit, in any order. The line
  // starts in the robot's cell, which is on it, and its end is not.
  //   visible:    lines to the occupied cells among the hits, each up to the first occupied cell;
  //   as_printed: lines to every occupied cell of the map, across other occupied cells; this goes
  //               through the whole map in each frame.
  void observe(const VoxelMap& map, const Eigen::Vector2d& robot_xy_world,
               std::span<const Eigen::Vector3i> hits, const NavmapParams& params);

  // Adds those of another map, moved by T_map_other and seen from above, as merge() of maps does.
  void merge(const SightLines& other, const SE3& T_map_other, double cell_size_m);

  // Forgets the free cells of which nothing was seen that the column rule asks for: lines that were
  // drawn between the obstacles of one band of heights say little of another one.
  void keep_seen(const VoxelMap& map, const NavmapParams& params);

  const CellSet& free_cells() const { return free_; }
  // Occupied cells that hysteresis may keep so; empty without hysteresis.
  const CellSet& held_cells() const { return held_; }
  bool operator==(const SightLines&) const = default;

 private:
  friend SightLines sight_lines_from_bytes(std::string_view bytes, const std::string& source);

  CellSet free_, held_;
};

// Whether a column is occupied: above the threshold, or held and not below it by the hysteresis.
bool is_occupied(const ColumnState& column, bool is_held, const NavmapParams& params);

// For VoxelMap::attachments. Equal sight lines have equal bytes.
std::string to_bytes(const SightLines& sight_lines);

// Throws Error "<source>: ..." when the bytes are not what to_bytes writes.
// Those attached to a map are none where nothing is attached.
SightLines attached_sight_lines(const VoxelMap& map, const std::string& source);
SightLines sight_lines_from_bytes(std::string_view bytes, const std::string& source);

}  // namespace stereovox
