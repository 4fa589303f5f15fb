// The ideal maps of a simulated world, in the words of the other stages.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "stereovox/evaluation/doorways.h"
#include "stereovox/evaluation/ideal_map.h"
#include "stereovox/occupancy/voxel_map.h"
#include "stereovox/simulation/ideal.h"

namespace stereovox {

// What can be reached from the start is free. Throws Error when the start is not on a free cell.
IdealMap ideal_map(const World& world, double cell_size_m, const HeightBand& band,
                   const Eigen::Vector2d& start_m);

// Every voxel from the floor to just below the ceiling is known: 1 occupied, 0 free.
VoxelMap ideal_voxel_map(const World& world, double voxel_size_m);

// "ideal_025cm.yaml"
std::string ideal_map_name(double cell_size_m);

std::vector<Doorway> doorways_of(const World& world);

// In the form that read_doorways reads.
void write_doorways(const std::filesystem::path& path, const std::vector<Doorway>& doorways);

}  // namespace stereovox
