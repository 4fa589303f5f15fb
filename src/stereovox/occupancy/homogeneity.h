// How much the neighbours of a voxel agree with it in one frame (eq. 15).
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <span>
#include <string>

#include "stereovox/core/parameters.h"

namespace stereovox {

enum class Neighbourhood { faces, cube };
std::span<const std::string> names_of(Neighbourhood);

enum class UnobservedNeighbours { excluded, count_as_zero };
std::span<const std::string> names_of(UnobservedNeighbours);

// In place of an observation, which lies in [0, 1].
inline constexpr float kUnobserved = -1.0F;

struct HomogeneityParams {
  Neighbourhood neighbours = Neighbourhood::faces;
  UnobservedNeighbours unobserved = UnobservedNeighbours::excluded;
  double min_homogeneity = 0.1;

  void describe(ParameterList& list);
};

// Steps to the neighbours, always in the same order.
std::span<const Eigen::Vector3i> neighbour_steps(Neighbourhood neighbours);

// H of eq. (15), which measures heterogeneity: the mean |O(V) - O(W)| over the neighbours W, whose
// observations (or kUnobserved) are given. 0 when there are none to count.
double heterogeneity(const HomogeneityParams& params, float observation,
                     std::span<const float> neighbours);

// The factor (1 - H) of eq. (16) with its floor, without which an isolated voxel never changes.
inline double homogeneity(const HomogeneityParams& params, double heterogeneity) {
  return std::max(params.min_homogeneity, 1.0 - heterogeneity);
}

}  // namespace stereovox
