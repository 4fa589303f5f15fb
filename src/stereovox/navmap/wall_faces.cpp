#include "stereovox/navmap/wall_faces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "stereovox/core/error.h"
#include "stereovox/navmap/column_states.h"
#include "stereovox/occupancy/byte_buffer.h"

namespace stereovox {
namespace {

constexpr std::string_view kMagic = "wall faces 2\n";
constexpr std::string_view kMagicOfOneSlice = "wall faces 1\n";
// With less the mean is not known to 3 mm, the bias aside.
constexpr float kMinInformation_per_m2 = 1e5F;
// Points of a surface near one border that err as far as half a cell look like a surface near the
// next one, but of little weight.
constexpr float kErrors = 0.25F;
// With more, the newest points count as if there were only so many older ones.
constexpr float kMaxInformation_per_m2 = 1e9F;

// The inverse variance that the point would have had on the border: with its own, points that err
// towards the camera would weigh more.
double weight_at_border(const PointMeasurement& point, int axis, double offset_m, double bias_m) {
  constexpr double kLeastSlope = 0.2;  // of rays that are not along the border
  const double slope = point.ray_world[axis];
  const double longer_m = std::abs(slope) < kLeastSlope ? 0.0 : -offset_m / slope;
  const double ratio = 1.0 + longer_m / point.range_m;
  const double sigma_m = point.sigma_range_m * ratio * ratio;
  return 1.0 / (sigma_m * sigma_m + bias_m * bias_m);
}

// To the nearer of the points that lie beside this one in the image; (0, 0) when there is none.
Eigen::Vector2d way_along_surface_m(const FrameView& frame, int u, int v,
                                    const Eigen::Vector3d& p_world) {
  constexpr int kBeside_px = 10;
  Eigen::Vector2d shortest_m(0.0, 0.0);
  for (const int beside : {u - kBeside_px, u + kBeside_px}) {
    if (beside < 0 || beside >= frame.disparity.width()) continue;
    const auto point = measure_pixel(frame, beside, v);
    if (!point) continue;
    const Eigen::Vector2d way_m = (point->p_world - p_world).head<2>();
    if (shortest_m.isZero() || way_m.squaredNorm() < shortest_m.squaredNorm()) shortest_m = way_m;
  }
  return shortest_m;
}

bool is_known(const WallFace& face) { return face.information_per_m2 >= kMinInformation_per_m2; }

// Whether voxels at this height above the floor count.
bool is_in_band(double height_m, const NavmapParams& params) {
  return params.column == ColumnRule::whole ||
         (params.min_height_m <= height_m && height_m <= params.max_height_m);
}

// In whole steps, if it is about that.
std::optional<int> whole_steps(double length_m, double step_m) {
  constexpr double kRounding = 1e-6;
  const double steps = length_m / step_m;
  if (std::abs(steps - std::round(steps)) > kRounding) return std::nullopt;
  return static_cast<int>(std::lround(steps));
}

// Bytes that to_bytes does not write.
struct Damaged : std::exception {};

bool is_valid(const WallFace& face) {
  return std::isfinite(face.mean_m) && face.information_per_m2 > 0.0F &&
         face.information_per_m2 <= kMaxInformation_per_m2;
}

}  // namespace

void WallFace::add(double offset_m, double weight_per_m2) {
  const double sum = static_cast<double>(information_per_m2) + weight_per_m2;
  mean_m += static_cast<float>((offset_m - static_cast<double>(mean_m)) * weight_per_m2 / sum);
  information_per_m2 = std::min(static_cast<float>(sum), kMaxInformation_per_m2);
}

void WallFaces::observe(const FrameView& frame, const FloorSurface& floor,
                        const NavmapParams& params) {
  FloorReader floor_reader(floor);
  const int step = frame.steps.surface_px;
  for (int v = first_sample(step); v < frame.disparity.height(); v += step)
    for (int u = first_sample(step); u < frame.disparity.width(); u += step) {
      const auto point = measure_pixel(frame, u, v);
      if (!point || !marks_surface(frame, *point) || !is_exact(frame, *point)) continue;
      const double height_m = point->p_world.z() - floor_reader.z_m(point->p_world.head<2>());
      if (!is_in_band(height_m, params)) continue;
      const Eigen::Vector2d way_m = way_along_surface_m(frame, u, v, point->p_world);
      Slice& slice = slices_[static_cast<int>(std::floor(height_m / kFaceSliceHeight_m))];
      for (const int axis : {0, 1})
        if (std::abs(way_m[axis]) <= std::abs(way_m[1 - axis]))
          add(*point, axis, frame.params.voxel_size_m, params.face_bias_m, slice);
    }
}

// To the nearest border along the axis.
void WallFaces::add(const PointMeasurement& point, int axis, double cell_size_m, double bias_m,
                    Slice& slice) {
  const Eigen::Vector2d place = point.p_world.head<2>() / cell_size_m;
  Eigen::Vector2i cell = place.array().floor().cast<int>();
  cell[axis] = static_cast<int>(std::lround(place[axis]));
  const bool is_from_above = point.ray_world[axis] < 0.0;
  const double offset_m = (place[axis] - cell[axis]) * cell_size_m;
  slice[tile_of(cell)][place_of(cell, axis, is_from_above)].add(
      offset_m, weight_at_border(point, axis, offset_m, bias_m));
}

// Of the border between a cell and the one from which `step` leads to it; the mean is positive
// where it lies in the cell.
WallFace WallFaces::face_behind(const Slice& slice, const Eigen::Vector2i& cell,
                                const Eigen::Vector2i& step) {
  const int axis = step.x() != 0 ? 0 : 1;
  const bool is_from_above = step[axis] > 0;
  // The border behind the cell is the lower end of the cell, or of the next one.
  Eigen::Vector2i owner = cell;
  if (!is_from_above) ++owner[axis];
  const auto found = slice.find(tile_of(owner));
  if (found == slice.end()) return {};
  WallFace face = found->second[place_of(owner, axis, is_from_above)];
  if (!is_from_above) face.mean_m = -face.mean_m;
  return face;
}

std::optional<double> WallFaces::reach_m(const Eigen::Vector2i& cell,
                                         const Eigen::Vector2i& step) const {
  std::optional<double> farthest_m;
  for (const auto& [height, slice] : slices_) {
    const WallFace back = face_behind(slice, cell, step),
                   front = face_behind(slice, cell + step, step);
    if (is_known(front) && front.information_per_m2 > kErrors * back.information_per_m2)
      return kWholeCell;
    if (is_known(back))
      farthest_m = std::max(farthest_m.value_or(-kWholeCell), static_cast<double>(back.mean_m));
  }
  return farthest_m;
}

bool WallFaces::merge(const WallFaces& other, const SE3& T_map_other, double cell_size_m) {
  const Eigen::Vector3d& shift_m = T_map_other.translation;
  const auto x = whole_steps(shift_m.x(), cell_size_m), y = whole_steps(shift_m.y(), cell_size_m);
  const auto slices = whole_steps(shift_m.z(), kFaceSliceHeight_m);
  if (!x || !y || !slices || !T_map_other.rotation.matrix().isIdentity()) return other.is_empty();
  for (const auto& [height, slice] : other.slices_) add_moved(height + *slices, slice, {*x, *y});
  return true;
}

void WallFaces::add_moved(int height, const Slice& slice, const Eigen::Vector2i& shift) {
  Slice& to = slices_[height];
  for (const auto& [index, tile] : slice)
    for (std::size_t i = 0; i < tile.size(); ++i) {
      if (tile[i].information_per_m2 <= 0.0F) continue;
      const Eigen::Vector2i cell = cell_at(index, static_cast<int>(i) / kFacesPerCell) + shift;
      const std::size_t face = i % kFacesPerCell;
      const auto first = static_cast<std::size_t>(position_in_tile(cell)) * kFacesPerCell;
      to[tile_of(cell)][first + face].add(static_cast<double>(tile[i].mean_m),
                                          static_cast<double>(tile[i].information_per_m2));
    }
}

WallFaces attached_wall_faces(const VoxelMap& map, const std::string& source) {
  const auto blob = map.attachments.find(kWallFacesAttachment);
  return blob == map.attachments.end() ? WallFaces{} : wall_faces_from_bytes(blob->second, source);
}

// The number of tiles as u32. Of each, i32 x, i32 y, one bit for each face that was seen, then mean
// and information of those as f32.
void WallFaces::append(const Slice& slice, std::string& bytes) {
  append_number(bytes, static_cast<std::uint32_t>(slice.size()));
  for (const auto& [index, tile] : slice) {
    append_number(bytes, static_cast<std::int32_t>(index.first));
    append_number(bytes, static_cast<std::int32_t>(index.second));
    std::string seen(tile.size() / 8, '\0'), values;
    for (std::size_t i = 0; i < tile.size(); ++i) {
      if (tile[i].information_per_m2 <= 0.0F) continue;
      seen[i / 8] = static_cast<char>(static_cast<unsigned char>(seen[i / 8]) | 1U << (i % 8));
      append_number(values, tile[i].mean_m);
      append_number(values, tile[i].information_per_m2);
    }
    bytes += seen + values;
  }
}

WallFaces::Slice WallFaces::take_slice(ByteReader& reader) {
  Slice slice;
  const auto count = reader.number<std::uint32_t>();
  for (std::uint32_t t = 0; t < count; ++t) {
    const auto x = reader.number<std::int32_t>();
    const TileIndex index(x, reader.number<std::int32_t>());
    if (!slice.empty() && !(slice.rbegin()->first < index)) throw Damaged();
    Tile& tile = slice[index];
    const std::string_view seen = reader.take(tile.size() / 8);
    if (std::ranges::all_of(seen, [](char bits) { return bits == 0; })) throw Damaged();
    for (std::size_t i = 0; i < tile.size(); ++i) {
      if ((static_cast<unsigned char>(seen[i / 8]) >> (i % 8) & 1U) == 0) continue;
      tile[i].mean_m = reader.number<float>();
      tile[i].information_per_m2 = reader.number<float>();
      if (!is_valid(tile[i])) throw Damaged();
    }
  }
  return slice;
}

// The number of slices as u32. Of each, its height as i32, and its tiles.
std::string to_bytes(const WallFaces& faces) {
  std::string bytes(kMagic);
  append_number(bytes, static_cast<std::uint32_t>(faces.slices_.size()));
  for (const auto& [height, slice] : faces.slices_) {
    append_number(bytes, static_cast<std::int32_t>(height));
    WallFaces::append(slice, bytes);
  }
  return bytes;
}

WallFaces wall_faces_from_bytes(std::string_view bytes, const std::string& source) {
  const bool has_slices = bytes.starts_with(kMagic);
  if (!has_slices && !bytes.starts_with(kMagicOfOneSlice))
    throw Error(source + ": the wall faces begin neither with 'wall faces 1' nor with 2");
  ByteReader reader(bytes.substr(kMagic.size()));
  WallFaces faces;
  try {
    const std::uint32_t count = has_slices ? reader.number<std::uint32_t>() : 1;
    for (std::uint32_t i = 0; i < count; ++i) {
      const int height = has_slices ? reader.number<std::int32_t>() : 0;
      if (i > 0 && height <= faces.slices_.rbegin()->first) throw Damaged();
      faces.slices_[height] = WallFaces::take_slice(reader);
    }
  } catch (const Damaged&) {
    throw Error(source + ": the wall faces are damaged");
  } catch (const std::out_of_range&) {
    throw Error(source + ": the wall faces are cut off");
  }
  if (!reader.is_at_end()) throw Error(source + ": bytes follow the wall faces");
  return faces;
}

}  // namespace stereovox
