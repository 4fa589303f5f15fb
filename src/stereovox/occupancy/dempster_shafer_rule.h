// Evidence after Dempster and Shafer (method.md D): a voxel has masses for occupied, free and
// unknown, so "never seen" and "seen both ways" differ. A hit brings the masses (c O, 0, 1 - c O),
// a crossing ray (0, e, 1 - e). The state is the pignistic value m(O) + m(Theta)/2.
#pragma once

#include <algorithm>
#include <span>
#include <string>

#include "stereovox/core/parameters.h"
#include "stereovox/occupancy/voxel_belief.h"

namespace stereovox {

// Where the mass goes on which two pieces of evidence contradict each other: Dempster's rule shares
// it out in proportion, Yager's calls it unknown.
enum class ConflictRule { dempster, yager };
std::span<const std::string> names_of(ConflictRule);

struct Masses {
  double occupied = 0.0, free = 0.0, unknown = 1.0;  // not negative; their sum is 1
};

// The two must not contradict each other wholly (occupied 1 and free 1) under Dempster's rule.
inline Masses combine(const Masses& a, const Masses& b, ConflictRule rule) {
  const double conflict = a.occupied * b.free + a.free * b.occupied;
  const double occupied = a.occupied * (b.occupied + b.unknown) + a.unknown * b.occupied;
  const double free = a.free * (b.free + b.unknown) + a.unknown * b.free;
  const double unknown = a.unknown * b.unknown;
  if (rule == ConflictRule::yager) return {occupied, free, unknown + conflict};
  const double agreed = 1.0 - conflict;
  return {occupied / agreed, free / agreed, unknown / agreed};
}

struct DempsterShaferRule {
  static constexpr const char* kName = "dempster_shafer";
  static constexpr bool kKeepsIgnorance = true;

  double hit_mass = 0.6;
  double free_mass = 0.3;
  double min_ignorance = 0.05;
  ConflictRule conflict = ConflictRule::dempster;

  void describe(ParameterList& list) {
    list("hit_mass", hit_mass, {0.01, 0.99}, "c: mass for occupied of a hit with full evidence");
    list("free_mass", free_mass, {0.01, 0.99}, "mass for free of a crossing ray");
    list("min_ignorance", min_ignorance, {0.001, 0.5},
         "mass that always stays unknown, so that no voxel is beyond persuasion");
    list("conflict", conflict, "contradiction is shared out in proportion, or becomes ignorance");
  }

  VoxelBelief after(const VoxelBelief& before, float observation) const {
    const double hit = hit_mass * static_cast<double>(observation);
    const Masses seen =
        observation > 0.0F ? Masses{hit, 0.0, 1.0 - hit} : Masses{0.0, free_mass, 1.0 - free_mass};
    const Masses now = with_ignorance(combine(masses_of(before), seen, conflict));
    return {now.occupied + 0.5 * now.unknown, now.unknown};
  }

 private:
  // A state near 0 or 1 leaves room for a part of the ignorance only, as in voxels of other rules.
  Masses masses_of(const VoxelBelief& belief) const {
    const double unknown =
        std::min({belief.ignorance, 2.0 * belief.state, 2.0 * (1.0 - belief.state)});
    return with_ignorance(
        {belief.state - 0.5 * unknown, 1.0 - belief.state - 0.5 * unknown, unknown});
  }
  Masses with_ignorance(const Masses& masses) const {
    if (masses.unknown >= min_ignorance) return masses;
    const double share = (1.0 - min_ignorance) / (masses.occupied + masses.free);
    return {masses.occupied * share, masses.free * share, min_ignorance};
  }
};

}  // namespace stereovox
