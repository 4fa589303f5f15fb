// Things of more than one part, as prisms.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "stereovox/simulation/prism.h"

namespace stereovox {

// Outer size: length along x, depth along y, height. Materials are positions in World::materials.

// A plate on four legs.
std::vector<Prism> table(const Placement& at, const Eigen::Vector3d& size_m, double leg_m,
                         int material);

// A seat, a back and four legs; looks towards +x.
std::vector<Prism> chair(const Placement& at, int material);

// A closed back and sides with boards and things on them.
std::vector<Prism> bookcase(const Placement& at, const Eigen::Vector3d& size_m, int boards,
                            double filled, std::uint32_t seed, int material, int content);

// Four posts a bay and open boards with boxes on them; one can see through where none stands.
std::vector<Prism> rack(const Placement& at, const Eigen::Vector3d& size_m, int levels, int bays,
                        double filled, std::uint32_t seed, int material, int content);

// A screen on a foot, standing at a height.
std::vector<Prism> monitor(const Placement& at, double bottom_m, int material, int screen);

}  // namespace stereovox
