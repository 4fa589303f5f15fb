// Where surfaces lie near the borders between cells, to a fraction of a cell. A surface a few
// centimetres from a border puts points into the cells on both sides of it, because each has an
// error; the states of both rise, and only the mean of the points tells in which of them it is.
// Heights are kept apart in slices, so that a shelf is not lost in the wall behind it.
//
//   WallFaces faces;
//   for each frame: faces.observe(frame, map.floor, params);
//   map.attachments[kWallFacesAttachment] = to_bytes(faces);
#pragma once

#include <array>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "stereovox/core/se3.h"
#include "stereovox/navmap/cell_set.h"
#include "stereovox/navmap/navmap_params.h"
#include "stereovox/occupancy/frame_view.h"

namespace stereovox {

class ByteReader;

inline constexpr const char* kWallFacesAttachment = "wall_faces";

inline constexpr double kFaceSliceHeight_m = 0.25;

// The mean of what was measured within half a cell of one border from one side of it, weighted by
// the inverse variance of each point's range.
struct WallFace {
  float mean_m = 0.0F;              // along the axis, from the border
  float information_per_m2 = 0.0F;  // sum of the weights, saturating; 0 = never seen

  void add(double offset_m, double weight_per_m2);
  bool operator==(const WallFace&) const = default;
};

class WallFaces {
 public:
  // Adds the points of a frame that are exact against the voxel (is_exact) and at the heights that
  // count, along the axes that their surface looks along, by at most 45 degrees: the side of a wall
  // says nothing of where it ends. To be called after the frame has been integrated.
  void observe(const FrameView& frame, const FloorSurface& floor, const NavmapParams& params);

  // How far the surfaces that are seen from the side to which `step` (a unit step along an axis)
  // leads reach into `cell` across the border with the cell on the other side: the farthest of all
  // heights, in metres, kWholeCell when one stands in the nearer half of the cell; negative when
  // all stay behind the border. Nothing when too little is known.
  static constexpr double kWholeCell = std::numeric_limits<double>::infinity();
  std::optional<double> reach_m(const Eigen::Vector2i& cell, const Eigen::Vector2i& step) const;

  // Adds those of another map, moved by T_map_other, and says whether it could: faces follow whole
  // cells and slices only, and no turn.
  bool merge(const WallFaces& other, const SE3& T_map_other, double cell_size_m);

  bool is_empty() const { return slices_.empty(); }
  bool operator==(const WallFaces&) const = default;

 private:
  friend std::string to_bytes(const WallFaces& faces);
  friend WallFaces wall_faces_from_bytes(std::string_view bytes, const std::string& source);

  // Of each cell, the border at its lower end: along x seen from below and from above, then along
  // y.
  static constexpr int kFacesPerCell = 4;
  using Tile = std::array<WallFace, kCellsPerTile * kFacesPerCell>;
  using Slice = std::map<TileIndex, Tile>;

  static std::size_t place_of(const Eigen::Vector2i& cell, int axis, bool is_from_above) {
    const int place = position_in_tile(cell) * kFacesPerCell + 2 * axis + (is_from_above ? 1 : 0);
    return static_cast<std::size_t>(place);
  }

  static void add(const PointMeasurement& point, int axis, double cell_size_m, double bias_m,
                  Slice& slice);
  void add_moved(int height, const Slice& slice, const Eigen::Vector2i& shift);
  static WallFace face_behind(const Slice& slice, const Eigen::Vector2i& cell,
                              const Eigen::Vector2i& step);
  static void append(const Slice& slice, std::string& bytes);
  static Slice take_slice(ByteReader& reader);

  std::map<int, Slice> slices_;  // by height above the floor, in kFaceSliceHeight_m
};

// For VoxelMap::attachments. Equal faces have equal bytes.
std::string to_bytes(const WallFaces& faces);

// Throws Error "<source>: ..." when the bytes are not what to_bytes writes.
// Those attached to a map are none where nothing is attached.
WallFaces attached_wall_faces(const VoxelMap& map, const std::string& source);
WallFaces wall_faces_from_bytes(std::string_view bytes, const std::string& source);

}  // namespace stereovox
