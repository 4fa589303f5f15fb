#include "stereovox/occupancy/homogeneity.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace stereovox {
namespace {

std::vector<Eigen::Vector3i> steps_to_cube() {
  std::vector<Eigen::Vector3i> steps;
  for (int z = -1; z <= 1; ++z)
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x)
        if (x != 0 || y != 0 || z != 0) steps.emplace_back(x, y, z);
  return steps;
}

std::vector<Eigen::Vector3i> steps_to_faces() {
  std::vector<Eigen::Vector3i> steps = steps_to_cube();
  std::erase_if(steps, [](const Eigen::Vector3i& s) { return s.cwiseAbs().sum() != 1; });
  return steps;
}

}  // namespace

std::span<const std::string> names_of(Neighbourhood) {
  static const std::vector<std::string> names = {"6", "26"};
  return names;
}

std::span<const std::string> names_of(UnobservedNeighbours) {
  static const std::vector<std::string> names = {"excluded", "zero"};
  return names;
}

void HomogeneityParams::describe(ParameterList& list) {
  list("neighbours", neighbours, "eq. (15): voxels that share a face, or also an edge or a corner");
  list("unobserved", unobserved,
       "eq. (15): neighbours not observed are left out, or count as free");
  list("min_homogeneity", min_homogeneity, {0, 1},
       "floor of 1 - H; 0 = an isolated voxel can never change");
}

std::span<const Eigen::Vector3i> neighbour_steps(Neighbourhood neighbours) {
  static const std::vector<Eigen::Vector3i> faces = steps_to_faces(), cube = steps_to_cube();
  return neighbours == Neighbourhood::faces ? faces : cube;
}

double heterogeneity(const HomogeneityParams& params, float observation,
                     std::span<const float> neighbours) {
  const bool exclude = params.unobserved == UnobservedNeighbours::excluded;
  double sum = 0.0;
  int count = 0;
  for (const float neighbour : neighbours) {
    if (exclude && neighbour == kUnobserved) continue;
    sum += std::abs(static_cast<double>(observation) - std::max(0.0F, neighbour));
    ++count;
  }
  return count == 0 ? 0.0 : sum / count;
}

}  // namespace stereovox
