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

constexpr std::string_view kWallFacesMagic = "wall faces 1\n";
// With less the mean is not known to 3 mm, the bias aside.
constexpr float kMinInformation_per_m2 = 1e5F;
// With more, the newest points count as if there were only so many older ones.
constexpr float kMaxInformation_per_m2 = 1e9F;

struct Band {
  double min_z_m, max_z_m;

  bool contains(double z_m) const { return min_z_m <= z_m && z_m <= max_z_m; }
};

// The heights of the voxels that count.
Band band_of(const FrameView& frame, double floor_z_m, const NavmapParams& params) {
  if (params.column == ColumnRule::whole) return {frame.min_z_m, frame.max_z_m};
  return {floor_z_m + params.min_height_m, floor_z_m + params.max_height_m};
}

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

void WallFaces::observe(const FrameView& frame, double floor_z_m, const NavmapParams& params) {
  const Band band = band_of(frame, floor_z_m, params);
  const int step = frame.steps.surface_px;
  for (int v = first_sample(step); v < frame.disparity.height(); v += step)
    for (int u = first_sample(step); u < frame.disparity.width(); u += step) {
      const auto point = measure_pixel(frame, u, v);
      if (point && band.contains(point->p_world.z()) && marks_surface(frame, *point) &&
          is_exact(frame, *point))
        add(*point, frame.params.voxel_size_m, params.face_bias_m);
    }
}

// To the nearest border along each axis.
void WallFaces::add(const PointMeasurement& point, double cell_size_m, double bias_m) {
  const double weight = 1.0 / (point.sigma_range_m * point.sigma_range_m + bias_m * bias_m);
  const Eigen::Vector2d place = point.p_world.head<2>() / cell_size_m;
  for (int axis = 0; axis < 2; ++axis) {
    Eigen::Vector2i cell = place.array().floor().cast<int>();
    cell[axis] = static_cast<int>(std::lround(place[axis]));
    const bool is_from_above = point.ray_world[axis] < 0.0;
    tiles_[tile_of(cell)][place_of(cell, axis, is_from_above)].add(
        (place[axis] - cell[axis]) * cell_size_m, weight);
  }
}

std::optional<double> WallFaces::reach_m(const Eigen::Vector2i& cell,
                                         const Eigen::Vector2i& step) const {
  const int axis = step.x() != 0 ? 0 : 1;
  const bool is_from_above = step[axis] > 0;
  // The border behind the cell is the lower end of the cell, or of the next one.
  Eigen::Vector2i owner = cell;
  if (!is_from_above) ++owner[axis];
  const auto found = tiles_.find(tile_of(owner));
  if (found == tiles_.end()) return std::nullopt;
  const WallFace& face = found->second[place_of(owner, axis, is_from_above)];
  if (face.information_per_m2 < kMinInformation_per_m2) return std::nullopt;
  return static_cast<double>(is_from_above ? face.mean_m : -face.mean_m);
}

// Of each tile: i32 x, i32 y, one bit for each face that was seen, then mean and information of
// those as f32.
std::string to_bytes(const WallFaces& faces) {
  std::string bytes(kWallFacesMagic);
  append_number(bytes, static_cast<std::uint32_t>(faces.tiles_.size()));
  for (const auto& [index, tile] : faces.tiles_) {
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
  return bytes;
}

WallFaces wall_faces_from_bytes(std::string_view bytes, const std::string& source) {
  const auto damaged = [&] { return Error(source + ": the wall faces are damaged"); };
  if (!bytes.starts_with(kWallFacesMagic))
    throw Error(source + ": the wall faces do not begin with 'wall faces 1'");
  ByteReader reader(bytes.substr(kWallFacesMagic.size()));
  WallFaces faces;
  try {
    const auto count = reader.number<std::uint32_t>();
    for (std::uint32_t t = 0; t < count; ++t) {
      const auto x = reader.number<std::int32_t>();
      const TileIndex index(x, reader.number<std::int32_t>());
      if (!faces.tiles_.empty() && !(faces.tiles_.rbegin()->first < index)) throw damaged();
      WallFaces::Tile& tile = faces.tiles_[index];
      const std::string_view seen = reader.take(tile.size() / 8);
      if (std::ranges::all_of(seen, [](char bits) { return bits == 0; })) throw damaged();
      for (std::size_t i = 0; i < tile.size(); ++i) {
        if ((static_cast<unsigned char>(seen[i / 8]) >> (i % 8) & 1U) == 0) continue;
        tile[i].mean_m = reader.number<float>();
        tile[i].information_per_m2 = reader.number<float>();
        if (!is_valid(tile[i])) throw damaged();
      }
    }
  } catch (const std::out_of_range&) {
    throw Error(source + ": the wall faces are cut off");
  }
  if (!reader.is_at_end()) throw Error(source + ": bytes follow the wall faces");
  return faces;
}

}  // namespace stereovox
