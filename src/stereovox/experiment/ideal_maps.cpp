#include "stereovox/experiment/ideal_maps.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <ostream>

#include "stereovox/io/atomic_file.h"

namespace stereovox {
namespace {

OccupancyGrid2D plan_of(const OccupiedCells& cells) {
  OccupancyGrid2D plan = unknown_grid(cells.geometry, "ideal map");
  for (std::size_t i = 0; i < plan.labels.size(); ++i) {
    plan.labels[i] = cells.is_occupied[i] ? CellLabel::occupied : CellLabel::free;
    plan.states[i] = cells.is_occupied[i] ? 1.0F : 0.0F;
  }
  return plan;
}

// Where the ideal voxels end: voxels above no camera here looks at, and the ceiling is no obstacle.
constexpr HeightBand kVoxelHeights{.min_m = -0.2, .max_m = 2.4};

}  // namespace

IdealMap ideal_map(const World& world, double cell_size_m, const HeightBand& band,
                   const Eigen::Vector2d& start_m) {
  return make_ideal(plan_of(occupied_cells(world, cell_size_m, band)), start_m);
}

VoxelMap ideal_voxel_map(const World& world, double voxel_size_m) {
  const OccupiedVoxels voxels = occupied_voxels(world, voxel_size_m, kVoxelHeights);
  VoxelMap map(voxel_size_m);
  for (int z = 0; z < voxels.size.z(); ++z)
    for (int y = 0; y < voxels.size.y(); ++y)
      for (int x = 0; x < voxels.size.x(); ++x) {
        const Eigen::Vector3i index = voxels.min + Eigen::Vector3i(x, y, z);
        const bool is_occupied = voxels.is_occupied[voxels.position_of(index)] != 0;
        map.set(index, {.state = is_occupied ? 1.0F : 0.0F, .last_seen_ms = 0, .observations = 1});
      }
  map.epoch_ns = 0;
  return map;
}

std::string ideal_map_name(double cell_size_m) {
  return fmt::format("ideal_{:03d}cm.yaml", static_cast<int>(std::lround(100 * cell_size_m)));
}

std::vector<Doorway> doorways_of(const World& world) {
  std::vector<Doorway> doorways;
  for (const DoorOpening& opening : world.doorways)
    doorways.push_back({opening.name, opening.a_m, opening.b_m});
  return doorways;
}

void write_doorways(const std::filesystem::path& path, const std::vector<Doorway>& doorways) {
  YAML::Emitter yaml;
  const auto point = [&](const Eigen::Vector2d& p) {
    yaml << YAML::Flow << YAML::BeginSeq << p.x() << p.y() << YAML::EndSeq;
  };
  yaml << YAML::BeginMap << YAML::Key << "doorways" << YAML::Value << YAML::BeginSeq;
  for (const Doorway& doorway : doorways) {
    yaml << YAML::Flow << YAML::BeginMap << YAML::Key << "name" << YAML::Value << YAML::DoubleQuoted
         << doorway.name << YAML::Key << "a" << YAML::Value;
    point(doorway.a_m);
    yaml << YAML::Key << "b" << YAML::Value;
    point(doorway.b_m);
    yaml << YAML::EndMap;
  }
  yaml << YAML::EndSeq << YAML::EndMap;
  write_text_atomically(path, std::string(yaml.c_str()) + "\n");
}

}  // namespace stereovox
