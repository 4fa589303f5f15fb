// Where the floor lies. It is level, as the map was told, until surfaces on which one can drive are
// seen to rise or to fall from it: ramps, roads over hills, or a level that was wrong by a degree.
// Heights are kept for squares of 0.5 m; between their centres they are interpolated, and beyond
// what was seen the nearest one holds.
//
//   map.floor.observe(surface_points(disparity, camera, T_world_camera, 8.0),
//                     T_world_camera.translation);
//   FloorReader floor(map.floor);
//   const double height_m = p.z() - floor.z_m(p.head<2>());
#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "stereovox/core/camera.h"
#include "stereovox/core/image.h"
#include "stereovox/core/se3.h"

namespace stereovox {

// A point of a surface, and whether the surface runs on flatly to the sampled points above and
// below it in the image. Those of floors do, and those of the tops of tables.
struct SurfacePoint {
  Eigen::Vector3d p_world;
  bool is_flat = false;
};

// Up to that depth, of every fourth pixel in each direction if the image is 640 pixels wide.
std::vector<SurfacePoint> surface_points(const DisparityImage& disparity,
                                         const RectifiedCamera& camera, const SE3& T_world_camera,
                                         double max_depth_m);

class FloorSurface {
 public:
  static constexpr double kSquare_m = 0.5;
  // A square's floor is that far from its neighbours' at most, 11 degrees: more is a step, not a
  // slope.
  static constexpr double kLargestStep_m = 0.1;
  // As long as fewer squares differ by more, the floor is level: one may be a heap, or an error.
  static constexpr double kTolerance_m = 0.05;
  static constexpr std::size_t kFewestSloped = 4;

  using Square = std::pair<int, int>;  // of (x, y) / kSquare_m
  struct Seen {
    float z_m = 0, weight_per_m2 = 0;  // mean, weighted by 1 / distance^2
    bool operator==(const Seen&) const = default;
  };

  explicit FloorSurface(double level_z_m = 0.0) : level_z_m_(level_z_m) {}

  double level_z_m() const { return level_z_m_; }
  // The points of one frame. From near the camera outwards, a square has a floor where most of its
  // points are flat and go on from the floor known so far.
  void observe(std::span<const SurfacePoint> points, const Eigen::Vector3d& camera_world);
  // Adds what another floor knows of the squares that this one does not know, moved by
  // T_this_other, which must keep z upright.
  void merge(const FloorSurface& other, const SE3& T_this_other);

  bool is_level() const { return sloped_ < kFewestSloped; }
  const std::map<Square, Seen>& squares() const { return squares_; }
  // The height of a square, or of the nearest ones that were seen; the level within the tolerance,
  // and farther than 5 m from all of them.
  double nearest_z_m(const Square& square) const;
  // Lowest and highest floor of the squares seen around a place, at most `radius_m` away along each
  // axis; the level where nothing was seen.
  std::pair<double, double> z_range_m(const Eigen::Vector2d& xy_world, double radius_m) const;
  std::pair<double, double> z_range_m() const;  // of all squares
  bool operator==(const FloorSurface&) const = default;

 private:
  friend FloorSurface floor_from_bytes(std::string_view bytes, double level_z_m);

  double z_m(const Seen& seen) const;
  std::pair<double, double> z_range_m(const Square& low, const Square& high) const;
  bool is_sloped(const Seen& seen) const;
  void add(const Square& square, const Seen& seen);
  // What the floor in a square must be near to: to that of its neighbours, or of the nearest
  // squares up to 1.5 m away, or else to the level.
  double expected_z_m(const Square& square) const;

  double level_z_m_;
  std::map<Square, Seen> squares_;
  std::size_t sloped_ = 0;  // squares beyond the tolerance
};

// Reads heights, and remembers what it has found for squares that were not seen. Refers to the
// floor, which must not change.
class FloorReader {
 public:
  explicit FloorReader(const FloorSurface& floor) : floor_(floor) {}

  double z_m(const Eigen::Vector2d& xy_world);

 private:
  // The heights around a place between four squares, of which this is the lowest in x and y.
  struct Patch {
    FloorSurface::Square square;
    double z_m[2][2];  // by x, then y
  };

  void read_patch(const FloorSurface::Square& square);
  double height_of(const FloorSurface::Square& square);

  const FloorSurface& floor_;
  std::map<FloorSurface::Square, double> heights_;
  std::optional<Patch> patch_;  // the last one: the next place mostly lies there, too
};

// The part of map.svx that holds the squares (docs/formats.md). Throws std::runtime_error when the
// bytes are not what to_bytes writes.
std::string to_bytes(const FloorSurface& floor);
FloorSurface floor_from_bytes(std::string_view bytes, double level_z_m);

}  // namespace stereovox
