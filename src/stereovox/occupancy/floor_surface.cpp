#include "stereovox/occupancy/floor_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "stereovox/occupancy/byte_buffer.h"

namespace stereovox {
namespace {

using Square = FloorSurface::Square;

constexpr std::string_view kMagic = "floor 1\n";
// No map reaches so far, and no number of a square overflows.
constexpr int kFarthestSquare = 1 << 28;

Square square_of(const Eigen::Vector3d& p) {
  return {static_cast<int>(std::floor(p.x() / FloorSurface::kSquare_m)),
          static_cast<int>(std::floor(p.y() / FloorSurface::kSquare_m))};
}

Eigen::Vector2d center_of(const Square& square) {
  return FloorSurface::kSquare_m * Eigen::Vector2d(square.first + 0.5, square.second + 0.5);
}

// What a frame shows in a square, whatever surfaces it belongs to.
struct SquareView {
  Square square;
  double distance_m;  // of its centre from the camera, seen from above
  std::vector<SurfacePoint> points;

  bool shows_enough() const {
    constexpr std::ptrdiff_t kFewestFlat = 8;
    return std::ranges::count_if(points, &SurfacePoint::is_flat) >= kFewestFlat;
  }
};

std::vector<SquareView> nearest_first(std::span<const SurfacePoint> points,
                                      const Eigen::Vector3d& camera_world) {
  std::map<Square, std::vector<SurfacePoint>> by_square;
  auto last = by_square.end();  // successive points mostly share a square
  for (const SurfacePoint& point : points) {
    const Square square = square_of(point.p_world);
    if (last == by_square.end() || last->first != square)
      last = by_square.try_emplace(square).first;
    last->second.push_back(point);
  }
  std::vector<SquareView> views;
  for (auto& [square, inside] : by_square)
    views.push_back(
        {square, (center_of(square) - camera_world.head<2>()).norm(), std::move(inside)});
  std::ranges::stable_sort(views, {}, &SquareView::distance_m);
  return views;
}

// The median height of the flat points near the expected height, if they are most of what is there.
std::optional<double> floor_among(std::span<const SurfacePoint> points, double expected_z_m) {
  constexpr double kAround_m = 0.5;  // a ceiling, or the room below, says nothing of the floor
  std::vector<double> floor_z_m;
  std::size_t around = 0;
  for (const auto& [p_world, is_flat] : points) {
    const double off_m = std::abs(p_world.z() - expected_z_m);
    if (off_m <= kAround_m) ++around;
    if (is_flat && off_m <= FloorSurface::kLargestStep_m) floor_z_m.push_back(p_world.z());
  }
  if (floor_z_m.empty() || 2 * floor_z_m.size() < around) return std::nullopt;
  const auto middle = floor_z_m.begin() + static_cast<std::ptrdiff_t>(floor_z_m.size() / 2);
  std::ranges::nth_element(floor_z_m, middle);
  return *middle;
}

// The mean height of the squares that are nearest to one and at most `farthest` squares away along
// each axis. Its eight neighbours and itself are equally near.
template <class Height>
std::optional<double> mean_of_nearest(const std::map<Square, FloorSurface::Seen>& squares,
                                      const Square& middle, int farthest, Height height_of) {
  constexpr int kNeighbours2 = 2;  // square of the distance to the farthest of them
  int nearest2 = std::numeric_limits<int>::max(), count = 0;
  double sum = 0.0;
  for (int x = middle.first - farthest; x <= middle.first + farthest; ++x)
    for (auto found = squares.lower_bound({x, middle.second - farthest});
         found != squares.end() && found->first <= Square{x, middle.second + farthest}; ++found) {
      const int across = x - middle.first, along = found->first.second - middle.second;
      const int distance2 = std::max(kNeighbours2, across * across + along * along);
      if (distance2 > nearest2) continue;
      if (distance2 < nearest2) nearest2 = distance2, count = 0, sum = 0.0;
      sum += height_of(found->second);
      ++count;
    }
  return count > 0 ? std::optional(sum / count) : std::nullopt;
}

// The point of a pixel; nothing when it has no disparity or is too far away.
class PixelPoints {
 public:
  PixelPoints(const DisparityImage& disparity, const RectifiedCamera& camera,
              const SE3& T_world_camera, double max_depth_m)
      : disparity_(disparity),
        camera_(camera),
        R_(T_world_camera.rotation.matrix()),
        origin_(T_world_camera.translation),
        max_depth_m_(max_depth_m) {}

  std::optional<Eigen::Vector3d> at(int u, int v) const {
    const float disparity_px = disparity_.disparity_px(v, u);
    if (!(disparity_px > 0.0F) || !std::isfinite(disparity_px)) return std::nullopt;
    const double depth_m = camera_.depth_m(static_cast<double>(disparity_px));
    if (depth_m > max_depth_m_) return std::nullopt;
    const PinholeCamera& c = camera_.pinhole;
    const Eigen::Vector3d ray((u - c.cx_px) / c.fx_px, (v - c.cy_px) / c.fy_px, 1.0);
    return origin_ + R_ * (depth_m * ray);
  }

 private:
  const DisparityImage& disparity_;
  const RectifiedCamera& camera_;
  Eigen::Matrix3d R_;
  Eigen::Vector3d origin_;
  double max_depth_m_;
};

bool runs_flatly(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  constexpr double kSteepest = 0.4;  // 22 degrees: the errors of two points are in it
  const Eigen::Vector3d way = to - from;
  return std::abs(way.z()) < kSteepest * way.head<2>().norm();
}

}  // namespace

std::vector<SurfacePoint> surface_points(const DisparityImage& disparity,
                                         const RectifiedCamera& camera, const SE3& T_world_camera,
                                         double max_depth_m) {
  constexpr int kSamplesAcross = 160;
  const int step = std::max(1, disparity.width() / kSamplesAcross);
  const PixelPoints pixels(disparity, camera, T_world_camera, max_depth_m);
  std::vector<SurfacePoint> points;
  for (int u = step / 2; u < disparity.width(); u += step) {
    bool is_flat_to_last = false, has_last = false;  // of this column, in the row above
    for (int v = step / 2; v < disparity.height(); v += step) {
      const auto point = pixels.at(u, v);
      const bool is_flat = point && has_last && runs_flatly(points.back().p_world, *point);
      if (has_last) points.back().is_flat = is_flat && is_flat_to_last;
      if (point) points.push_back({*point, false});
      is_flat_to_last = is_flat;
      has_last = point.has_value();
    }
  }
  return points;
}

void FloorSurface::observe(std::span<const SurfacePoint> points,
                           const Eigen::Vector3d& camera_world) {
  for (const SquareView& view : nearest_first(points, camera_world)) {
    if (!view.shows_enough()) continue;
    const auto z_m = floor_among(view.points, expected_z_m(view.square));
    const double distance_m = std::max(view.distance_m, kSquare_m);
    if (z_m)
      add(view.square,
          {static_cast<float>(*z_m), static_cast<float>(1.0 / (distance_m * distance_m))});
  }
}

void FloorSurface::merge(const FloorSurface& other, const SE3& T_this_other) {
  for (const auto& [square, seen] : other.squares_) {
    Eigen::Vector3d p;
    p << center_of(square), static_cast<double>(seen.z_m);
    const Eigen::Vector3d moved = T_this_other * p;
    const Square place = square_of(moved);
    if (!squares_.contains(place)) add(place, {static_cast<float>(moved.z()), seen.weight_per_m2});
  }
}

double FloorSurface::z_m(const Seen& seen) const {
  return is_sloped(seen) ? static_cast<double>(seen.z_m) : level_z_m_;
}

std::pair<double, double> FloorSurface::z_range_m(const Eigen::Vector2d& xy_world,
                                                  double radius_m) const {
  if (is_level()) return {level_z_m_, level_z_m_};
  const Eigen::Vector3d radius(radius_m, radius_m, 0.0), at(xy_world.x(), xy_world.y(), 0.0);
  return z_range_m(square_of(at - radius), square_of(at + radius));
}

std::pair<double, double> FloorSurface::z_range_m() const {
  if (is_level()) return {level_z_m_, level_z_m_};
  constexpr int kFarthest = std::numeric_limits<int>::max();
  return z_range_m({-kFarthest, -kFarthest}, {kFarthest, kFarthest});
}

std::pair<double, double> FloorSurface::z_range_m(const Square& low, const Square& high) const {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  std::pair<double, double> range(kNone, -kNone);
  for (auto found = squares_.lower_bound(low);
       found != squares_.end() && found->first.first <= high.first;) {
    const auto [x, y] = found->first;
    if (y < low.second || y > high.second) {
      found = squares_.lower_bound({y < low.second ? x : x + 1, low.second});
      continue;
    }
    const double z = z_m(found->second);
    range = {std::min(range.first, z), std::max(range.second, z)};
    ++found;
  }
  return range.first <= range.second ? range : std::pair(level_z_m_, level_z_m_);
}

bool FloorSurface::is_sloped(const Seen& seen) const {
  return std::abs(static_cast<double>(seen.z_m) - level_z_m_) > kTolerance_m;
}

void FloorSurface::add(const Square& square, const Seen& seen) {
  Seen& known = squares_[square];
  if (known.weight_per_m2 > 0.0F && is_sloped(known)) --sloped_;
  known.weight_per_m2 += seen.weight_per_m2;
  known.z_m += (seen.z_m - known.z_m) * (seen.weight_per_m2 / known.weight_per_m2);
  if (is_sloped(known)) ++sloped_;
}

double FloorSurface::expected_z_m(const Square& square) const {
  constexpr int kFarthest = 3;
  const auto height_of = [](const Seen& seen) { return static_cast<double>(seen.z_m); };
  return mean_of_nearest(squares_, square, kFarthest, height_of).value_or(level_z_m_);
}

double FloorSurface::nearest_z_m(const Square& square) const {
  constexpr int kFarthest = 10;
  const auto height_of = [&](const Seen& seen) { return z_m(seen); };
  if (const auto found = squares_.find(square); found != squares_.end()) return z_m(found->second);
  return mean_of_nearest(squares_, square, kFarthest, height_of).value_or(level_z_m_);
}

double FloorReader::z_m(const Eigen::Vector2d& xy_world) {
  if (floor_.is_level()) return floor_.level_z_m();
  const Eigen::Vector2d place = xy_world.array() / FloorSurface::kSquare_m - 0.5;
  const Eigen::Vector2d low = place.array().floor();
  const Eigen::Vector2d share = place - low;
  const Square first(static_cast<int>(low.x()), static_cast<int>(low.y()));
  if (!patch_ || patch_->square != first) read_patch(first);
  const auto along_y = [&](const double(&z_m)[2]) {
    return (1.0 - share.y()) * z_m[0] + share.y() * z_m[1];
  };
  return (1.0 - share.x()) * along_y(patch_->z_m[0]) + share.x() * along_y(patch_->z_m[1]);
}

void FloorReader::read_patch(const Square& square) {
  const auto [x, y] = square;
  patch_ = Patch{square,
                 {{height_of({x, y}), height_of({x, y + 1})},
                  {height_of({x + 1, y}), height_of({x + 1, y + 1})}}};
}

double FloorReader::height_of(const Square& square) {
  const auto [found, is_new] = heights_.try_emplace(square);
  if (is_new) found->second = floor_.nearest_z_m(square);
  return found->second;
}

// The number of squares as u32. Of each, i32 x, i32 y, f32 height, f32 weight, in order.
std::string to_bytes(const FloorSurface& floor) {
  std::string bytes(kMagic);
  append_number(bytes, static_cast<std::uint32_t>(floor.squares().size()));
  for (const auto& [square, seen] : floor.squares()) {
    append_number(bytes, static_cast<std::int32_t>(square.first));
    append_number(bytes, static_cast<std::int32_t>(square.second));
    append_number(bytes, seen.z_m);
    append_number(bytes, seen.weight_per_m2);
  }
  return bytes;
}

FloorSurface floor_from_bytes(std::string_view bytes, double level_z_m) {
  if (!bytes.starts_with(kMagic))
    throw std::runtime_error("the floor does not begin with 'floor 1'");
  ByteReader reader(bytes.substr(kMagic.size()));
  FloorSurface floor(level_z_m);
  const auto count = reader.number<std::uint32_t>();
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto x = reader.number<std::int32_t>();
    const Square square(x, reader.number<std::int32_t>());
    const float z_m = reader.number<float>(), weight_per_m2 = reader.number<float>();
    const bool is_next = floor.squares_.empty() || floor.squares_.rbegin()->first < square;
    const bool is_near = std::max(std::abs(std::int64_t{x}),
                                  std::abs(std::int64_t{square.second})) <= kFarthestSquare;
    if (!is_next || !is_near || !std::isfinite(z_m) || !std::isfinite(weight_per_m2) ||
        weight_per_m2 <= 0.0F)
      throw std::runtime_error("the floor is damaged");
    floor.add(square, {z_m, weight_per_m2});
  }
  if (!reader.is_at_end()) throw std::runtime_error("bytes follow the floor");
  return floor;
}

}  // namespace stereovox
