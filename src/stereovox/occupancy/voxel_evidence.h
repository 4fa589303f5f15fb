// What the points of one frame say about one voxel together (eq. 13): the union of their evidence
// plus a bonus for density. Counts only, so the order of the points does not matter.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <variant>

#include "stereovox/core/parameters.h"

namespace stereovox {

// A voxel's observation is left to the rays that crossed it.
inline constexpr float kNothingSaid = -1.0F;

// Values of a surface profile between these say next to nothing: log-odds of less than 0.04.
inline constexpr float kMaxFreeProfile = 0.48F, kMinOccupiedProfile = 0.52F;

struct VoxelEvidence {
  static constexpr int kLevels = 32;  // evidence is counted to the nearest of 0, 1/31, ..., 1
  static constexpr unsigned kInside = 1, kExact = 2;

  float largest = 0.0F, smallest = 1.0F;
  std::array<std::uint32_t, 4> count_of_kind{};  // kInside, kExact, both or neither
  std::array<std::uint32_t, kLevels> count_of_level{};

  // `is_exact`: the point's error is small against the voxel.
  void add(float evidence, bool is_inside, bool is_exact = false) {
    largest = std::max(largest, evidence);
    smallest = std::min(smallest, evidence);
    const bool is_said_exactly = is_exact && evidence > 0.0F;
    add_level(static_cast<unsigned>(level_of(evidence)),
              (is_inside ? kInside : 0) | (is_said_exactly ? kExact : 0));
  }
  // The nearest level of an evidence in [0, 1].
  [[gnu::always_inline]] static int level_of(float evidence) {
    // A call of lround would keep loops from becoming vector instructions.
    // NOLINTNEXTLINE(bugprone-incorrect-roundings)
    return static_cast<int>(evidence * (kLevels - 1) + 0.5F);
  }
  // All that unions by rank ask for, of so many equal points. `level` is that of some evidence.
  void add_level(unsigned level, unsigned kind, std::uint32_t points = 1) {
    count_of_kind[kind] += points;
    count_of_level[level] += points;
  }
  std::uint32_t points_inside() const { return count_of_kind[1] + count_of_kind[3]; }
  std::uint32_t exact_points() const { return count_of_kind[2] + count_of_kind[3]; }
};

// The printed union: one point decides.
struct MaxUnion {
  static constexpr const char* kName = "max";
  void describe(ParameterList&) {}
  double strength(const VoxelEvidence& evidence, double) const {
    return static_cast<double>(evidence.largest);
  }
};

// The K-th largest evidence, where K is a share of the points that a full face would send: a few
// mismatches cannot lift a voxel. With `majority`, K is also that share of the exact points that
// say anything of the voxel. A surface just behind a voxel, whose errors put some points into it,
// then does not occupy it: most of the points near it lie beyond. A thin thing alone still does.
struct RankUnion {
  static constexpr const char* kName = "rank";

  double quantile = 0.05, majority = 0.0;

  void describe(ParameterList& list) {
    list("quantile", quantile, {0, 1},
         "share of the pixels of a voxel's face that must agree; 0 = one point is enough");
    list("majority", majority, {0, 1},
         "share of the exact points in and around a voxel that must agree; exact is an error of "
         "less than half a voxel");
  }

  double strength(const VoxelEvidence& evidence, double expected_points) const {
    const double needed =
        std::max({1.0, quantile * expected_points, majority * evidence.exact_points()});
    constexpr double kMost = std::numeric_limits<std::uint32_t>::max();
    const auto rank = static_cast<std::uint32_t>(std::ceil(std::min(needed, kMost)));
    std::uint32_t seen = 0;
    for (int level = VoxelEvidence::kLevels - 1; level > 0; --level) {
      seen += evidence.count_of_level[static_cast<std::size_t>(level)];
      if (seen >= rank) return static_cast<double>(level) / (VoxelEvidence::kLevels - 1);
    }
    return 0.0;
  }
};

using UnionRule = std::variant<MaxUnion, RankUnion>;

// lambda npts / (6 r^3) as printed. Given as a share of the voxel's volume, lambda is good for
// every voxel size.
struct PrintedDensity {
  static constexpr const char* kName = "printed";

  double lambda_voxels = 0.0075;

  void describe(ParameterList& list) {
    list("lambda_voxels", lambda_voxels, {0, 1},
         "lambda of eq. (13) in voxel volumes; 0.0075 adds 0.01 per point");
  }
  double bonus(const VoxelEvidence& evidence, double) const {
    constexpr double kVolumeByPrinted = 8.0 / 6.0;  // 8 r^3 / 6 r^3
    return lambda_voxels * kVolumeByPrinted * evidence.points_inside();
  }
};

// lambda times the share of the points that a full face would send.
struct RelativeDensity {
  static constexpr const char* kName = "relative";

  double lambda = 0.1;

  void describe(ParameterList& list) {
    list("lambda", lambda, {0, 1}, "evidence added to a voxel whose face is fully covered");
  }
  double bonus(const VoxelEvidence& evidence, double expected_points) const {
    return lambda * std::min(1.0, evidence.points_inside() / expected_points);
  }
};

using DensityBonus = std::variant<PrintedDensity, RelativeDensity>;

// O_t of eq. (13).
template <class Union, class Density>
float observation_of(const VoxelEvidence& evidence, double expected_points, const Union& union_rule,
                     const Density& density) {
  return static_cast<float>(std::min(1.0, union_rule.strength(evidence, expected_points) +
                                              density.bonus(evidence, expected_points)));
}

// The same of a surface profile, where 0.5 says nothing: the voxel is as occupied as the union
// says. When the union has too few points for that it is free, as those that say least against it
// say, or wholly where rays have crossed it. kNothingSaid when no point speaks against it either.
template <class Union>
float profile_observation_of(const VoxelEvidence& evidence, double expected_points, bool is_crossed,
                             const Union& union_rule) {
  const auto strength = static_cast<float>(union_rule.strength(evidence, expected_points));
  if (strength >= kMinOccupiedProfile) return strength;
  if (is_crossed) return std::min(strength, kMaxFreeProfile);
  const float least = std::max(strength, evidence.smallest);
  return least <= kMaxFreeProfile ? least : kNothingSaid;
}

}  // namespace stereovox
