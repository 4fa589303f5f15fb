#include "stereovox/occupancy/export_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "stereovox/core/error.h"
#include "stereovox/core/grid_geometry.h"
#include "stereovox/io/atomic_file.h"
#include "stereovox/occupancy/byte_buffer.h"

namespace stereovox {
namespace {

template <class Visit>
void for_each_exported(const VoxelMap& map, const QueryParams& params, ExportedVoxels which,
                       Visit visit) {
  const MapQueries queries(map, params);
  map.for_each_block([&](const VoxelBlock& block) {
    for_each_in(block.voxels.known(), [&](int i) {
      const Voxel voxel = block.voxels[static_cast<std::size_t>(i)];
      const VoxelState state = queries.state_of(voxel);
      if (state == VoxelState::occupied ||
          (state == VoxelState::free && which == ExportedVoxels::known))
        visit(voxel_center_of(map.voxel_size_m(), voxel_at(block.index, i)), voxel.state);
    });
  });
}

// From blue at the floor over green to red at 2.5 m.
std::array<std::uint8_t, 3> colour_at(double height_m) {
  constexpr double kTop_m = 2.5, kFull = 255.0;
  const double level = std::clamp(height_m / kTop_m, 0.0, 1.0);
  const auto ramp = [&](double peak) {
    const double value = std::clamp(1.5 - 4.0 * std::abs(level - peak), 0.0, 1.0);
    return static_cast<std::uint8_t>(std::lround(kFull * value));
  };
  return {ramp(0.75), ramp(0.5), ramp(0.25)};
}

std::string ply_header(std::size_t points) {
  std::string text = "ply\nformat binary_little_endian 1.0\ncomment voxel centres, metres\n";
  text += fmt::format("element vertex {}\n", points);
  for (const char* name : {"x", "y", "z", "occupancy"})
    text += fmt::format("property float {}\n", name);
  for (const char* name : {"red", "green", "blue"})
    text += fmt::format("property uchar {}\n", name);
  return text + "end_header\n";
}

std::string pcd_header(std::size_t points) {
  return fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z occupancy\n"
      "SIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH {0}\nHEIGHT 1\n"
      "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS {0}\nDATA binary\n",
      points);
}

}  // namespace

void export_points(std::ostream& out, PointForm form, const VoxelMap& map,
                   const QueryParams& params, ExportedVoxels which) {
  std::size_t points = 0;
  for_each_exported(map, params, which, [&](const Eigen::Vector3d&, float) { ++points; });
  out << (form == PointForm::ply ? ply_header(points) : pcd_header(points));
  std::string bytes;
  for_each_exported(map, params, which, [&](const Eigen::Vector3d& center_m, float state) {
    bytes.clear();
    for (const double coordinate : center_m) append_number(bytes, static_cast<float>(coordinate));
    append_number(bytes, state);
    if (form == PointForm::ply)
      for (const std::uint8_t part : colour_at(center_m.z() - map.floor_z_m()))
        append_number(bytes, part);
    out << bytes;
  });
}

void export_points(const std::filesystem::path& path, const VoxelMap& map,
                   const QueryParams& params, ExportedVoxels which) {
  const std::string form = path.extension();
  if (form != ".ply" && form != ".pcd")
    throw Error(path.string() + ": a point cloud ends in .ply or .pcd");
  write_file_atomically(path, [&](std::ostream& out) {
    export_points(out, form == ".ply" ? PointForm::ply : PointForm::pcd, map, params, which);
  });
}

}  // namespace stereovox
